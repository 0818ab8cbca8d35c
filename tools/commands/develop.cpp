#include "host/film/display/develop.h"
#include "host/report/json_file.h"
#include "reradiant/error.h"
#include "tools/program/command.h"
#include "tools/program/display_options.h"
#include "tools/program/groups_option.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>

#include <memory>

namespace reradiant {

namespace {

struct DevelopCommand {
    std::filesystem::path input, output;
    std::string groups;
    DisplayTexts display;
};

nlohmann::ordered_json result_json(const DevelopCommand& command, const Picture& picture) {
    nlohmann::ordered_json json = {{"image", command.input.string()},
                                   {"picture", command.output.string()},
                                   {"width", picture.width},
                                   {"height", picture.height},
                                   {"exposure_ev", picture.exposure_ev},
                                   {"white_xy", nullptr},
                                   {"gamut", command.display.gamut},
                                   {"out_of_gamut", picture.out_of_gamut}};
    if (picture.white_xy)
        json["white_xy"] = *picture.white_xy;
    return json;
}

void print_summary(const DevelopCommand& command, const Picture& picture) {
    const double pixels = static_cast<double>(picture.width) * static_cast<double>(picture.height);
    fmt::print("{}: {} x {} pixels at {:+.3g} EV", command.output.string(), picture.width,
               picture.height, picture.exposure_ev);
    if (picture.white_xy)
        fmt::print(", white x = {:.4f}, y = {:.4f}", (*picture.white_xy)[0],
                   (*picture.white_xy)[1]);
    fmt::print("; {:.3g} % of the pixels lie outside the display's gamut{}\n",
               100.0 * static_cast<double>(picture.out_of_gamut) / pixels,
               command.display.gamut == "compress" ? ", before compression" : "");
}

int run_develop(const DevelopCommand& command, const CommandContext& context) {
    const DevelopOptions options = parse_display_options(command.display);
    const LightFactors factors = parse_groups_option(command.groups);
    check_outputs(context.common,
                  {{.option = "-o",
                    .file = command.output,
                    .endings = {".png", ".jpg", ".jpeg", ".tif", ".tiff"},
                    .ending_chooses = true}},
                  {command.input});
    check_develop(options);
    const Picture picture = develop(read_image(command.input, factors), options);
    write_picture(command.output, picture);
    write_json(context.common.json, result_json(command, picture));
    if (!context.common.quiet)
        print_summary(command, picture);
    return 0;
}

} // namespace

void add_develop_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<DevelopCommand>();
    Command app = program.add_command(
        "develop",
        "Makes a picture of a spectral image: exposure, white, gamut, without rendering");
    app.option("IMAGE", command->input, "spectral EXR").required();
    app.option("-o,--output", command->output, "picture to write: .png, .jpg or .tif").required();
    add_groups_option(app, command->groups);
    add_display_options(app, command->display);
    app.footer("Example: reradiant develop out.exr -o out.png --exposure auto --white A --gamut "
               "compress");
    app.callback([command, &context] { context.exit_code = run_develop(*command, context); });
}

} // namespace reradiant
