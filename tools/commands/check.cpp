#include "host/check/check.h"
#include "host/device/device_checks.h"
#include "host/report/json_file.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace reradiant {

namespace {

constexpr int exit_check_failed = 3;

struct CheckCommandOptions {
    CheckOptions check;
    std::filesystem::path save, against;
};

nlohmann::ordered_json to_json(const FunctionReport& function, bool in_double) {
    nlohmann::ordered_json json = {{"name", function.name},
                                   {"header", function.header},
                                   {"inputs", function.inputs},
                                   {"max_ulp", function.max_ulp},
                                   {"ulp_99_9", function.most_ulp},
                                   {"max_relative", function.max_relative},
                                   {"relative_99_9", function.most_relative},
                                   {"relative_allowed", function.allowed_relative},
                                   {"reason", function.reason},
                                   {"of_budget", function.of_budget},
                                   {"open_share", function.open_share},
                                   {"nanoseconds", function.nanoseconds},
                                   {"passed", function.passed()},
                                   {"failures", function.failures}};
    if (in_double)
        json["double"] = {{"nanoseconds", function.double_nanoseconds},
                          {"max_relative", function.double_max_relative}};
    return json;
}

nlohmann::ordered_json to_json(const CheckReport& report, const DeviceInfo& device,
                               bool in_double) {
    nlohmann::ordered_json functions = nlohmann::ordered_json::array();
    for (const FunctionReport& function : report.functions)
        functions.push_back(to_json(function, in_double));
    return {{"device", device.name},
            {"driver", device.driver},
            {"passed", report.passed()},
            {"seconds", report.seconds},
            {"build_seconds", report.build.seconds},
            {"functions", functions}};
}

void print_head(bool in_double) {
    fmt::print("{:<32} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7} {:>8}{}\n", "function", "max ULP",
               "99.9 %", "max rel.", "99.9 %", "budget", "open", "ns",
               in_double ? "  ns double  max rel." : "");
}

void print_row(const FunctionReport& function, bool in_double) {
    fmt::print("{:<32} {:>9.3g} {:>9.3g} {:>9.2e} {:>9.2e} {:>7.2g} {:>7.2g} {:>8.1f}",
               function.name, function.max_ulp, function.most_ulp, function.max_relative,
               function.most_relative, function.of_budget, function.open_share,
               function.nanoseconds);
    if (in_double && function.double_nanoseconds > 0.0)
        fmt::print(" {:>10.1f} {:>10.2e}", function.double_nanoseconds,
                   function.double_max_relative);
    fmt::print("{}\n", function.passed() ? "" : "  FAILED");
    std::fflush(stdout);
}

int run_check(const CheckCommandOptions& options, const CommonOptions& common) {
    check_outputs(common, {{"--save", options.save, {".json"}}});
    std::optional<SavedResults> saved;
    if (!options.against.empty())
        saved = read_saved_results(options.against);
    prepare_opencl(common.threads);
    const Device device(common.device);
    const bool in_double = options.check.in_double;
    print_head(in_double);
    CheckReport report = check_device(device, options.check, [&](const FunctionReport& function) {
        print_row(function, in_double);
    });
    if (options.check.only.empty())
        remember_device_check(device.info(), report.passed());
    if (saved)
        compare_results(*saved, report);
    if (!options.save.empty())
        save_results(options.save, device, report);
    write_json(common.json, to_json(report, device.info(), in_double));
    for (const FunctionReport& function : report.functions)
        for (const std::string& failure : function.failures)
            fmt::print(stderr, "{}: {}: {}\n", function.header, function.name, failure);
    fmt::print("{} functions on '{}' {} in {:.1f} s, {:.1f} of them building\n",
               report.functions.size(), device.info().name, report.passed() ? "passed" : "FAILED",
               report.seconds, report.build.seconds);
    return report.passed() ? 0 : exit_check_failed;
}

} // namespace

void add_check_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<CheckCommandOptions>();
    Command command = program.add_command(
        "check", "Runs every device function on the device against double precision, over hard "
                 "and random inputs: errors, budgets of the OpenCL specification, speed; exit 3 "
                 "when one fails");
    command.option("--samples", options->check.samples, "random inputs a function")
        .in_range(std::size_t{1000}, std::size_t{1} << 32U)
        .show_default();
    command.option("--only", options->check.only, "functions with this in their name");
    command.flag("--double", options->check.in_double,
                 "build the functions in double too: what single precision costs and saves");
    command.option("--save", options->save, "write the results, for --against");
    command.option("--against", options->against,
                   "fail too when a result moved by more than its budget since --save");
    command.footer("budget: largest error over what OpenCL allows there; open: share that a "
                   "comparison decides.\n"
                   "Examples:\n"
                   "  reradiant check --only fresnel\n"
                   "  reradiant check --save before.json\n"
                   "  reradiant check --against before.json");
    command.callback(
        [options, &context] { context.exit_code = run_check(*options, context.common); });
}

} // namespace reradiant
