#include "tools/program/display_options.h"

#include "host/scene/lights/lamp_file.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <charconv>
#include <stdexcept>

namespace reradiant {

namespace {

std::optional<double> number(std::string_view text) {
    if (text.starts_with('+'))
        text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

std::array<double, 2> chromaticity(const Xyz& xyz) {
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

/// X,Y of a chromaticity; nothing where the text is no pair of numbers.
std::optional<std::array<double, 2>> pair_of_numbers(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos)
        return std::nullopt;
    const auto x = number(std::string_view(text).substr(0, comma));
    const auto y = number(std::string_view(text).substr(comma + 1));
    if (!x || !y)
        return std::nullopt;
    return std::array<double, 2>{*x, *y};
}

void read_exposure(const std::string& text, DevelopOptions& options) {
    options.auto_exposure = text == "auto";
    if (options.auto_exposure)
        return;
    const std::optional<double> exposure = number(text);
    if (!exposure)
        throw_input_error({}, fmt::format("--exposure is '{}', which is no number", text),
                          "give EV from -100 to 100, or auto");
    options.display.exposure_ev = *exposure;
}

} // namespace

void set_white(const char* option, const std::string& text, DevelopOptions& options) {
    options.auto_white = text == "auto";
    options.white_xy.reset();
    if (text == "auto" || text == "D65")
        return;
    options.white_xy = pair_of_numbers(text);
    if (!options.white_xy) {
        const Lamp lamp = white_lamp(option, text);
        options.white_xy = chromaticity(xyz_of(lamp.weighted_by ? *lamp.weighted_by : lamp.light));
    }
}

Lamp white_lamp(const char* option, const std::string& text) {
    std::error_code ignored;
    Lamp lamp;
    try {
        lamp = std::filesystem::is_regular_file(text, ignored) ? read_lamp_file(text)
                                                               : lamp_from_text(text);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("{}: {}", option, error.what()));
    }
    if (const std::string faint = faint_white_warning(lamp, Observer::Cie1931Deg2); !faint.empty())
        throw_input_error({}, fmt::format("{}: {}", option, faint));
    return lamp;
}

Xyz white_of_lamp(const char* option, const std::string& text, double luminance) {
    const Lamp lamp = white_lamp(option, text);
    Xyz white = xyz_of(lamp.weighted_by ? *lamp.weighted_by : lamp.light);
    const double scale = luminance / white[1];
    for (double& value : white)
        value *= scale;
    return white;
}

void add_display_options(Command& command, DisplayTexts& texts) {
    command.option("--exposure", texts.exposure,
                   "exposure of the picture in EV; auto: shows the median of what is not black at "
                   "0.6 of white, where it is not from 0.1 to 0.9 as it is");
    command.option("--white", texts.white,
                   "the light that becomes white, by Bradford adaptation: a lamp as `colour` "
                   "takes it, its file, chromaticity x,y, or auto (the median colour of "
                   "the image); D65 is white as it is");
    command
        .option("--gamut", texts.gamut,
                "what the display cannot show: clip (each channel by itself) or compress (hue and "
                "differences stay)")
        .one_of({"clip", "compress"});
    command.option("--ocio", texts.ocio, "OpenColorIO config");
    command.option("--display", texts.display, "display of the config, or a built-in one");
    command.option("--view", texts.view, "view of the display");
}

DevelopOptions parse_display_options(const DisplayTexts& texts) {
    DevelopOptions options;
    options.display.ocio_config = texts.ocio;
    options.display.display = texts.display;
    options.display.view = texts.view;
    read_exposure(texts.exposure, options);
    set_white("--white", texts.white, options);
    options.gamut = texts.gamut == "compress" ? Gamut::Compress : Gamut::Clip;
    return options;
}

} // namespace reradiant
