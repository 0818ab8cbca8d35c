#include "reradiant/merge.h"
#include "host/base/logging.h"
#include "host/film/display/display_picture.h"
#include "host/film/image_memory.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"
#include "tools/program/command.h"
#include "tools/program/display_options.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <memory>

namespace reradiant {

namespace {

struct MergeCommand {
    std::vector<std::filesystem::path> parts;
    std::filesystem::path output, png;
    DisplayTexts display;
    std::uint64_t memory_limit_bytes = 0;
};

int run_merge(const MergeCommand& command, const CommandContext& context) {
    check_outputs(context.common,
                  {{"-o", command.output, {".exr"}}, {"--png", command.png, {".png"}}},
                  command.parts);
    const DevelopOptions options = parse_display_options(command.display);
    check_exposure(options.display.exposure_ev);
    if (!command.png.empty())
        check_develop(options);
    check_merge_memory(command.parts, command.memory_limit_bytes);
    MergedImage merged = merge_images(command.parts);
    for (const SampleRange& gap : merged.gaps)
        logging::warn("samples {} to {} are missing", gap.first, gap.end - 1);
    auto& attributes = merged.image.attributes;
    attributes["reradiant:commandLine"] = context.command_line;
    Picture picture;
    picture.exposure_ev = options.display.exposure_ev;
    if (!command.png.empty() || options.auto_exposure)
        picture = develop(merged.image, options);
    write_spectral_exr(command.output, merged.image, picture.exposure_ev, merged.light_layers);
    if (!command.png.empty())
        write_picture(command.png, picture);
    const std::string& ranges = attributes.at(sample_ranges_attribute);
    write_json(context.common.json, {{"parts", command.parts.size()},
                                     {"spp", std::stoull(attributes.at("reradiant:samples"))},
                                     {"ranges", ranges},
                                     {"gaps", sample_ranges_text(merged.gaps)}});
    if (!context.common.quiet)
        fmt::print("{}: {} samples a pixel ({}) from {} parts\n", command.output.string(),
                   attributes.at("reradiant:samples"), ranges, command.parts.size());
    return 0;
}

} // namespace

void add_merge_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<MergeCommand>();
    Command app = program.add_command(
        "merge", "Adds partial renders of disjoint sample ranges, whatever their order");
    app.option("PART", command->parts, "spectral EXR of `render --sample-range`").required();
    app.option("-o,--output", command->output, "spectral EXR to write").required();
    app.option("--png", command->png, "write the display image too");
    add_display_options(app, command->display);
    app.option("--memory-limit", command->memory_limit_bytes,
               "refuse parts that would take more bytes (default: 80 % of the machine's)");
    app.footer("Example: reradiant render s.toml -o a.exr --sample-range 0:64\n"
               "         reradiant render s.toml -o b.exr --sample-range 64:128\n"
               "         reradiant merge a.exr b.exr -o all.exr");
    app.callback([command, &context] { context.exit_code = run_merge(*command, context); });
}

} // namespace reradiant
