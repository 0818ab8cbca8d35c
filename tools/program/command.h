#pragma once

#include "tools/program/command_line.h"

#include <filesystem>
#include <functional>
#include <string>

namespace reradiant {

/// Options that every sub-command takes.
struct CommonOptions {
    std::string device; ///< --device or $RERADIANT_DEVICE; empty: first device
    unsigned seed = 0;
    int threads = 0; ///< 0: all
    std::filesystem::path json;
    bool quiet = false;
    bool verbose = false;
};

/// The state that every sub-command shares. A command's function adds itself to the program and
/// leaves its result in `exit_code`; failures leave as Error and become exit codes in main.cpp:
///
///     void add_info_command(Program& program, CommandContext& context) {
///         Command command = program.add_command("info", "says what a file holds");
///         command.option("FILE", ...).required();
///         command.footer("Example: reradiant info out.exr");
///         command.callback([...] { context.exit_code = run_info(...); });
///     }
///
/// The common options are added to every sub-command by main.cpp, after that.
struct CommandContext {
    CommonOptions common;
    int exit_code = 0;
    std::string command_line; ///< as typed, for the attributes of images
};

/// One function a sub-command, one file each: tools/commands/render.cpp and so on.
void add_render_command(Program& program, CommandContext& context);
void add_measure_command(Program& program, CommandContext& context);
void add_validate_command(Program& program, CommandContext& context);
void add_info_command(Program& program, CommandContext& context);
void add_devices_command(Program& program, CommandContext& context);
void add_convert_command(Program& program, CommandContext& context);
void add_compare_command(Program& program, CommandContext& context);
void add_converge_command(Program& program, CommandContext& context);
void add_develop_command(Program& program, CommandContext& context);
void add_probe_command(Program& program, CommandContext& context);
void add_figure_command(Program& program, CommandContext& context);
void add_study_command(Program& program, CommandContext& context);
void add_view_command(Program& program, CommandContext& context);
void add_merge_command(Program& program, CommandContext& context);
void add_synth_command(Program& program, CommandContext& context);
void add_colour_command(Program& program, CommandContext& context);
void add_fit_command(Program& program, CommandContext& context);
void add_classify_command(Program& program, CommandContext& context);
void add_check_command(Program& program, CommandContext& context);

} // namespace reradiant
