#include "host/base/atomic_file.h"
#include "host/base/output_ending.h"
#include "host/figure/figure_layout.h"
#include "host/figure/svg_drawing.h"
#include "host/report/json_file.h"
#include "tools/commands/figure/figure_panels.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace reradiant {

namespace {

struct FigureCommand {
    std::filesystem::path input, output;
};

nlohmann::ordered_json result_json(const FigureCommand& command, const FigureRequest& request,
                                   const std::vector<ReadImage>& images) {
    nlohmann::ordered_json json = {{"figure", command.output.string()},
                                   {"images", nlohmann::ordered_json::array()},
                                   {"marks", nlohmann::ordered_json::array()}};
    for (std::size_t index = 0; index < images.size(); ++index) {
        const ImageRequest& image = request.images[index];
        const Picture& picture = images[index].picture;
        json["images"].push_back({{"name", image.name},
                                  {"exposure_ev", picture.exposure_ev},
                                  {"white_xy", nullptr},
                                  {"out_of_gamut", picture.out_of_gamut}});
        if (picture.white_xy)
            json["images"].back()["white_xy"] = *picture.white_xy;
        for (std::size_t k = 0; k < image.marks.size(); ++k) {
            const RegionValues& values = images[index].marks[k].values;
            json["marks"].push_back({{"name", image.name + "." + image.marks[k].name},
                                     {"pixels", values.pixels},
                                     {"XYZ", values.xyz},
                                     {"luminance_stderr", values.luminance_stderr}});
        }
    }
    return json;
}

void write_figure(const std::filesystem::path& file, const std::string& svg, double dpi) {
    const std::string ending = lower_case_ending(file);
    if (ending == ".svg")
        write_text_atomically(file, svg_with_outlines(svg));
    else if (ending == ".pdf")
        write_text_atomically(file, pdf_of_svg(svg));
    else
        write_picture(file, picture_of_svg(svg, dpi));
}

/// Refuses pictures that no drawing has room for.
void check_pixels(const FigureCommand& command, const Figure& figure, double dpi) {
    const double longest = std::max(figure.width, layout_of(figure).height) * dpi / 72.0;
    if (lower_case_ending(command.output) == ".png" && longest > largest_drawing_side)
        throw_input_error(
            {command.input.string()},
            fmt::format("the figure would have {:.0f} pixels a side", longest),
            fmt::format("at most {} are drawn: lower dpi or width_mm", largest_drawing_side));
}

std::size_t panel_count(const Figure& figure) {
    std::size_t count = 0;
    for (const auto& row : figure.rows)
        count += row.size();
    return count;
}

int run_figure(const FigureCommand& command, const CommandContext& context) {
    const FigureRequest request = read_figure_request(command.input);
    std::vector<std::filesystem::path> read{command.input};
    for (const ImageRequest& image : request.images)
        read.push_back(image.file);
    check_outputs(context.common,
                  {{.option = "-o",
                    .file = command.output,
                    .endings = {".svg", ".pdf", ".png"},
                    .ending_chooses = true}},
                  read);
    const std::vector<ReadImage> images = read_images(request);
    const Figure figure = figure_of(request, images);
    check_pixels(command, figure, request.dpi);
    write_figure(command.output, figure_svg(figure), request.dpi);
    write_json(context.common.json, result_json(command, request, images));
    if (!context.common.quiet)
        fmt::print("{}: {} panels\n", command.output.string(), panel_count(figure));
    return 0;
}

} // namespace

void add_figure_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<FigureCommand>();
    Command app = program.add_command(
        "figure", "Puts images, the spectra and colours of marked places, titles and a caption "
                  "into one figure for print");
    app.option("FIGURE", command->input, "what the figure shows (TOML)").required();
    app.option("-o,--output", command->output,
               "figure to write: .svg, .pdf (both with their fonts) or .png")
        .required();
    app.footer("Example: reradiant figure figure.toml -o figure.pdf");
    app.callback([command, &context] { context.exit_code = run_figure(*command, context); });
}

} // namespace reradiant
