#include "host/view/lights/lights_page.h"

#include "host/film/colour_image.h"
#include "host/film/display/picture_levels.h"
#include "host/report/html.h"
#include "host/report/page_parts.h"
#include "host/view/lights/layer_code.h"
#include "host/view/page_lamps.h"
#include "host/view/page_sources.h"
#include "host/view/tables/model_tables.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"

#include <algorithm>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_pixels = 1 << 20;

const char* part_name(LightPart part) {
    return part == LightPart::Whole ? "whole" : part == LightPart::Ultraviolet ? "uv" : "visible";
}

/// What a page shows of an image: its size there, and pixels of the file along one of the page.
struct Shown {
    int width, height, block, file_width;

    explicit Shown(const SpectralImage& image) : block(1), file_width(image.width) {
        const double pixels = static_cast<double>(image.width) * image.height;
        while (pixels / block / block > static_cast<double>(most_pixels))
            ++block;
        width = std::max(1, image.width / block);
        height = std::max(1, image.height / block);
    }

    /// Means over blocks of (height, width, band).
    std::vector<float> reduced(const std::vector<float>& values, std::size_t bands) const {
        if (block == 1)
            return values;
        std::vector<float> small;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (std::size_t band = 0; band < bands; ++band) {
                    double sum = 0.0;
                    for (int v = y * block; v < (y + 1) * block; ++v)
                        for (int u = x * block; u < (x + 1) * block; ++u)
                            sum += static_cast<double>(
                                values[(static_cast<std::size_t>(v) *
                                            static_cast<std::size_t>(file_width) +
                                        static_cast<std::size_t>(u)) *
                                           bands +
                                       band]);
                    small.push_back(static_cast<float>(sum / block / block));
                }
        return small;
    }
};

Json layer_json(const LightLayer& layer, const Shown& shown, const WavelengthGrid& bands) {
    Json json = {
        {"name", layer.name()},  {"group", layer.group}, {"part", part_name(layer.part)},
        {"from", layer.from_nm}, {"to", layer.to_nm},    {"lamp", encoded_floats(layer.lamp)},
        {"codes", Json::array()}};
    const auto values = shown.reduced(layer.values, static_cast<std::size_t>(bands.count));
    for (const LayerCode& code : layer_codes(values, bands))
        json["codes"].push_back({{"first", code.first_band},
                                 {"bands", code.bands},
                                 {"rank", code.rank},
                                 {"basis", encoded_floats({code.basis.begin(), code.basis.end()})},
                                 {"low", code.log_low},
                                 {"rms", code.rms_error},
                                 {"worst", code.worst_error},
                                 {"packed", packed(code)}});
    return json;
}

Json layers_json(const LightsPage& page, const SpectralImage& image, const Shown& shown) {
    Json layers = Json::array();
    read_light_layers(page.image, [&](LightLayer&& layer) {
        layers.push_back(layer_json(layer, shown, image.bands));
    });
    if (layers.empty())
        layers.push_back(layer_json({"picture",
                                     LightPart::Whole,
                                     image.bands.lower_edge_nm(0),
                                     image.bands.upper_edge_nm(image.bands.count - 1),
                                     {},
                                     image.values},
                                    shown, image.bands));
    return layers;
}

std::vector<double> weights_of(const WavelengthGrid& bands) {
    std::vector<double> numbers;
    for (const Xyz& weights : xyz_weights(bands))
        numbers.insert(numbers.end(), weights.begin(), weights.end());
    return numbers;
}

} // namespace

std::string lights_page(const LightsPage& page) {
    const SpectralImage image = read_spectral_exr(page.image);
    if (std::all_of(image.values.begin(), image.values.end(), [](float v) { return v == 0.0f; }))
        throw_input_error({page.image.string()}, "is black: there is no light to slide",
                          "give a picture that shows something");
    const Shown shown(image);
    const Json data = {{"name", page.image.filename().string()},
                       {"width", shown.width},
                       {"height", shown.height},
                       {"block", shown.block},
                       {"exposure", exposure_of_level(body_level(xyz_image(image)))},
                       {"bands",
                        {{"from", image.bands.from_nm},
                         {"step", image.bands.step_nm},
                         {"count", image.bands.count}}},
                       {"weights", encoded_floats(weights_of(image.bands))},
                       {"lengthStep", LayerCode::length_step},
                       {"directionStep", LayerCode::direction_step},
                       {"lamps", lamps_json(page.lamps)},
                       {"layers", layers_json(page, image, shown)}};
    return html_document(
        page.image.filename().string(), std::string(page_style) + view_css + lights_css,
        std::string(lights_html) + "<noscript><p>This page needs scripts.</p></noscript>\n" +
            script_data("lights-data", data) + "<script>\n" + page_script + view_start_js +
            view_inputs_js + view_spectra_js + lights_layers_js + lights_js + "</script>\n");
}

} // namespace reradiant
