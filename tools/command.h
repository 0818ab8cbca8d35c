#pragma once

#include <CLI/CLI.hpp>

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

/// What a sub-command registers: it adds its options to `app` and returns nothing; its callback
/// returns the exit code by way of `run`.
struct CommandContext {
    CommonOptions common;
    int exit_code = 0;
    std::string command_line; ///< as typed, for the attributes of images
};

/// One function a sub-command, one file each: tools/render.cpp and so on.
void add_render_command(CLI::App& app, CommandContext& context);
void add_measure_command(CLI::App& app, CommandContext& context);
void add_validate_command(CLI::App& app, CommandContext& context);
void add_info_command(CLI::App& app, CommandContext& context);
void add_devices_command(CLI::App& app, CommandContext& context);
void add_convert_command(CLI::App& app, CommandContext& context);
void add_compare_command(CLI::App& app, CommandContext& context);

} // namespace reradiant
