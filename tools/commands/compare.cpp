#include "host/film/image_memory.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"
#include "reradiant/spectral_image.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace reradiant {

namespace {

constexpr int exit_comparison_failed = 3;

struct CompareOptions {
    std::filesystem::path image, reference;
    std::optional<double> max_relmse;
    std::uint64_t memory_limit_bytes = 0;
};

Comparison compare_files(const CompareOptions& options) {
    check_compare_memory(options.image, options.reference, options.memory_limit_bytes);
    const SpectralImage image = read_spectral_exr(options.image);
    const SpectralImage reference = read_spectral_exr(options.reference);
    try {
        return compare_images(image, reference);
    } catch (const Error& error) {
        throw_input_error({options.image.string()},
                          fmt::format("cannot be compared with {}: {}", options.reference.string(),
                                      error.what()));
    }
}

int run_compare(const CompareOptions& options, const CommonOptions& common) {
    check_outputs(common, {}, {options.image, options.reference});
    const Comparison result = compare_files(options);
    const nlohmann::ordered_json json = {
        {"relmse", result.relmse},
        {"relmse_srgb", result.relmse_srgb},
        {"rmse", result.rmse},
        {"bias", result.bias},
        {"bias_stderr", result.bias_stderr},
        {"ciede2000", result.ciede2000},
    };
    write_json(common.json, json);
    for (const auto& [key, value] : json.items())
        fmt::print("{:<12} {:.9g}\n", key, value.get<double>());
    // Written so that an error that is not a number fails too.
    if (options.max_relmse && !(result.relmse <= *options.max_relmse)) {
        fmt::print(stderr, "{}: relmse {:.9g} is over the limit of {:.9g}\n",
                   options.image.string(), result.relmse, *options.max_relmse);
        return exit_comparison_failed;
    }
    return 0;
}

} // namespace

void add_compare_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<CompareOptions>();
    Command command =
        program.add_command("compare", "Compares a spectral image with a reference: relMSE, "
                                       "RMSE, bias with its standard error, CIEDE2000");
    command.option("IMAGE", options->image, "spectral EXR").required();
    command.option("REFERENCE", options->reference, "spectral EXR of the same size and bands")
        .required();
    command.option("--max-relmse", options->max_relmse, "exit with 3 when relMSE is higher")
        .non_negative();
    command.option("--memory-limit", options->memory_limit_bytes,
                   "refuse images that would take more bytes (default: 80 % of the machine's)");
    command.footer("Example: reradiant compare out.exr reference.exr --max-relmse 0.01");
    command.callback(
        [options, &context] { context.exit_code = run_compare(*options, context.common); });
}

} // namespace reradiant
