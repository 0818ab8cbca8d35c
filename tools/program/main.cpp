#include "host/cluster/cluster.h"
#include "reradiant/error.h"
#include "tools/program/command.h"
#include "tools/program/versions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>
#include <string>
#include <vector>

namespace reradiant {

namespace {

constexpr int exit_failure = 1;
constexpr int exit_bad_input = 2;

void add_commands(Program& program, CommandContext& context) {
    add_render_command(program, context);
    add_measure_command(program, context);
    add_synth_command(program, context);
    add_colour_command(program, context);
    add_fit_command(program, context);
    add_compare_command(program, context);
    add_converge_command(program, context);
    add_study_command(program, context);
    add_view_command(program, context);
    add_merge_command(program, context);
    add_develop_command(program, context);
    add_probe_command(program, context);
    add_figure_command(program, context);
    add_validate_command(program, context);
    add_info_command(program, context);
    add_classify_command(program, context);
    add_check_command(program, context);
    add_convert_command(program, context);
    add_devices_command(program, context);
}

void add_common_options(Command command, CommonOptions& common) {
    command
        .option("--device", common.device,
                "OpenCL device by (part of its) name or index, see `devices`")
        .environment("RERADIANT_DEVICE");
    command.option("--seed", common.seed, "seed of the random numbers").show_default();
    command.option("--threads", common.threads, "threads of the host, 0: all")
        .in_range(0, 65536)
        .show_default();
    command.option("--json", common.json, "write a machine-readable result to this file");
    const CommandOption quiet = command.flag("--quiet", common.quiet,
                                             "no warnings, no progress, no word of what was "
                                             "written; results (of colour, info, check, ...) "
                                             "are printed all the same");
    command.flag("--verbose", common.verbose, "say more: each material's model, what was left out")
        .excludes(quiet);
    command.version(version_text());
    // Before the command's own callback runs, so that its messages obey.
    command.before_callback([&common] {
        if (common.quiet)
            spdlog::set_level(spdlog::level::err);
        else if (common.verbose)
            spdlog::set_level(spdlog::level::debug);
    });
}

/// The command line as one would type it again in a POSIX shell.
std::string quoted_command_line(int argc, char** argv) {
    constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                  "0123456789_-+=./:,@%";
    std::string line;
    for (int i = 0; i < argc; ++i) {
        const std::string argument = argv[i];
        const bool safe =
            !argument.empty() && argument.find_first_not_of(plain) == std::string::npos;
        line += i > 0 ? " " : "";
        if (safe) {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char character : argument)
            line += character == '\'' ? std::string("'\\''") : std::string(1, character);
        line += '\'';
    }
    return line;
}

int fail(int code, const std::string& message) {
    fail_in_cluster(code, message);
    return code;
}

int parse_and_run(Program& program, CommandContext& context, int argc, char** argv) {
    const std::vector<std::string> names = program.command_names();
    const std::string list = fmt::format("{}", fmt::join(names, ", "));
    if (argc < 2)
        return fail(exit_bad_input,
                    fmt::format("reradiant: no command given; take one of: {}", list));
    const std::string first = argv[1];
    if (!first.starts_with("-") && std::find(names.begin(), names.end(), first) == names.end())
        return fail(exit_bad_input,
                    fmt::format("reradiant: unknown command '{}'; take one of: {}", first, list));
    try {
        program.parse_and_run(argc, argv);
    } catch (const CommandLineError& error) {
        return fail(exit_bad_input,
                    fmt::format("reradiant: {}; see `reradiant {}--help`", error.what(),
                                first.starts_with("-") ? "" : first + " "));
    }
    return context.exit_code;
}

int run(int argc, char** argv) {
    auto log = spdlog::stderr_logger_mt("reradiant");
    log->set_pattern("%l: %v");
    spdlog::set_default_logger(log);

    CommandContext context;
    context.command_line = quoted_command_line(argc, argv);
    Program program("Renders and measures fluorescent layered materials.", "reradiant",
                    version_text());
    program.footer("`reradiant COMMAND --help` says more about a command.");
    add_commands(program, context);
    for (const Command& command : program.commands())
        add_common_options(command, context.common);
    return parse_and_run(program, context, argc, argv);
}

} // namespace

} // namespace reradiant

int main(int argc, char** argv) {
    using namespace reradiant;
    try {
        return run(argc, argv);
    } catch (const Error& error) {
        return fail(error.exit_code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(exit_failure, "out of memory; use a smaller film, fewer bands or fewer "
                                  "threads");
    } catch (const std::exception& error) {
        return fail(exit_failure, fmt::format("reradiant failed: {}", error.what()));
    }
}
