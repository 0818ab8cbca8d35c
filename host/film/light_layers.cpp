#include "reradiant/spectral_image.h"

#include "host/exr/exr_input.h"
#include "host/film/exr_layout.h"
#include "host/film/lamp_cells.h"
#include "host/film/light_layer_header.h"
#include "host/film/spectral_part.h"
#include "reradiant/error.h"

#include <ImfChannelList.h>
#include <ImfStringAttribute.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::pair<LightPart, const char*> part_names[] = {
    {LightPart::Whole, "whole"}, {LightPart::Ultraviolet, "uv"}, {LightPart::Visible, "visible"}};

std::string numbers_text(const std::vector<double>& numbers) {
    return fmt::format("{:.9g}", fmt::join(numbers, " "));
}

/// Finite numbers between spaces; empty where the text is something else.
std::vector<double> numbers_of(std::string_view text) {
    std::vector<double> numbers;
    while (!text.empty()) {
        double number = 0.0;
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (code != std::errc() || !std::isfinite(number))
            return {};
        numbers.push_back(number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.starts_with(' '))
            text.remove_prefix(1);
    }
    return numbers;
}

std::string text_of(const Imf::Header& header, const char* name) {
    const auto* const text = header.findTypedAttribute<Imf::StringAttribute>(name);
    return text ? text->value() : std::string();
}

bool is_layer(const Imf::Header& header) {
    return !text_of(header, exr_layout::light_group_attribute).empty();
}

LightLayer layer_of(const fs::path& file, const Imf::Header& header) {
    LightLayer layer;
    layer.group = text_of(header, exr_layout::light_group_attribute);
    const std::string part = text_of(header, exr_layout::light_part_attribute);
    bool is_right = false;
    for (const auto& [value, name] : part_names)
        if (part == name) {
            layer.part = value;
            is_right = true;
        }
    const auto range = numbers_of(text_of(header, exr_layout::light_range_attribute));
    layer.lamp = numbers_of(text_of(header, exr_layout::lamp_attribute));
    if (!is_right || range.size() != 2 || !(range[0] < range[1]) ||
        (!layer.lamp.empty() && layer.lamp.size() != lamp_cells))
        throw_input_error({file.string()},
                          fmt::format("its layer of the lights '{}' is damaged", layer.group),
                          "render the image again");
    layer.from_nm = range[0];
    layer.to_nm = range[1];
    return layer;
}

/// The factor of each layer. Refuses names that are not among the layers'.
std::vector<double> factors_of(const fs::path& file, const std::vector<LightLayer>& layers,
                               const LightFactors& factors) {
    std::vector<std::string> names;
    for (const LightLayer& layer : layers)
        for (const std::string& name : {layer.group, layer.name()})
            if (std::find(names.begin(), names.end(), name) == names.end())
                names.push_back(name);
    for (const auto& [name, factor] : factors)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw_input_error({file.string()}, fmt::format("has no light group '{}'", name),
                              fmt::format("it has {}", fmt::join(names, ", ")));
    const auto factor_of = [&](const std::string& name) {
        const auto found = factors.find(name);
        return found == factors.end() ? 1.0 : found->second;
    };
    std::vector<double> of_layers;
    for (const LightLayer& layer : layers)
        of_layers.push_back(factor_of(layer.group) *
                            (layer.part == LightPart::Whole ? 1.0 : factor_of(layer.name())));
    return of_layers;
}

} // namespace

std::vector<double> lamp_cell_means(const Spectrum& lamp) {
    std::vector<double> means;
    for (int cell = 0; cell < lamp_cells; ++cell) {
        const double centre = lamp_from_nm + cell;
        means.push_back(lamp.average(centre - 0.5, centre + 0.5));
    }
    return means;
}

std::string LightLayer::name() const {
    return part == LightPart::Whole         ? group
           : part == LightPart::Ultraviolet ? group + ".uv"
                                            : group + ".visible";
}

void describe_layer(Imf::Header& header, const LightLayer& layer) {
    const auto insert = [&](const char* name, const std::string& text) {
        header.insert(name, Imf::StringAttribute(text));
    };
    insert(exr_layout::light_group_attribute, layer.group);
    for (const auto& [value, name] : part_names)
        if (layer.part == value)
            insert(exr_layout::light_part_attribute, name);
    insert(exr_layout::light_range_attribute, numbers_text({layer.from_nm, layer.to_nm}));
    insert(exr_layout::lamp_attribute, numbers_text(layer.lamp));
}

std::vector<LightLayer> light_layers_of(const fs::path& file) {
    return with_exr_input(file, [&](Imf::MultiPartInputFile& input) {
        std::vector<LightLayer> layers;
        for (int part = 0; part < input.parts(); ++part)
            if (is_layer(input.header(part)))
                layers.push_back(layer_of(file, input.header(part)));
        return layers;
    });
}

void read_light_layers(const fs::path& file, const std::function<void(LightLayer&&)>& use) {
    with_exr_input(file, [&](Imf::MultiPartInputFile& input) {
        const Imf::Header& first = input.header(spectral_part(input));
        for (int part = 0; part < input.parts(); ++part) {
            const Imf::Header& header = input.header(part);
            if (!is_layer(header))
                continue;
            LightLayer layer = layer_of(file, header);
            bool is_alike = header.dataWindow() == first.dataWindow() &&
                            header.displayWindow() == first.displayWindow();
            for (auto channel = header.channels().begin(); channel != header.channels().end();
                 ++channel)
                is_alike = is_alike && first.channels().findChannel(channel.name()) != nullptr;
            if (!is_alike)
                throw_input_error({file.string()},
                                  fmt::format("its layer '{}' has another size or other bands than "
                                              "the image",
                                              layer.name()),
                                  "render the image again");
            layer.values = read_spectral_part(input, part, file).values;
            use(std::move(layer));
        }
    });
}

SpectralImage read_relit_image(const fs::path& file, const LightFactors& factors) {
    const std::vector<LightLayer> layers = light_layers_of(file);
    if (layers.empty())
        throw_input_error({file.string()}, "holds no light groups",
                          "render it with --light-groups");
    const std::vector<double> by_layer = factors_of(file, layers, factors);
    SpectralImage image = read_spectral_exr(file);
    image.variance_y.clear();
    image.variance_bands.clear();
    std::fill(image.values.begin(), image.values.end(), 0.0f);
    std::size_t k = 0;
    read_light_layers(file, [&](LightLayer&& layer) {
        const double factor = by_layer[k++];
        if (layer.values.size() != image.values.size())
            throw_input_error({file.string()},
                              fmt::format("its layer '{}' lacks bands of the image", layer.name()),
                              "render the image again");
        for (std::size_t i = 0; i < image.values.size(); ++i)
            image.values[i] = static_cast<float>(image.values[i] + factor * layer.values[i]);
    });
    return image;
}

} // namespace reradiant
