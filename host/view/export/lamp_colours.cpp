#include "host/view/export/lamp_colours.h"

#include "host/layers/rough/facet_reflectance.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace reradiant {

namespace {

using Rgb = LampColours::Rgb;

/// Colours of radiance factors on bands under a lamp.
class LampEye {
public:
    LampEye(const WavelengthGrid& bands, const Lamp& lamp) : weights_(xyz_weights(bands)) {
        for (int band = 0; band < bands.count; ++band)
            light_.push_back(
                lamp.light.average(bands.lower_edge_nm(band), bands.upper_edge_nm(band)));
        white_ = seen(light_);
        if (!(*std::min_element(white_.begin(), white_.end()) > 0.0))
            throw_input_error({},
                              fmt::format("lamp '{}' has no white that renderers of three colours "
                                          "could hold",
                                          lamp.name),
                              "name a lamp with light in the whole visible range");
    }

    const std::vector<double>& light() const { return light_; }
    /// Linear sRGB of what is sent back, by band.
    Rgb colour(const std::vector<double>& sent) const {
        Xyz xyz = seen(sent);
        Xyz white = white_;
        for (std::size_t k = 0; k < 3; ++k) {
            xyz[k] /= white_[1];
            white[k] /= white_[1];
        }
        return xyz_to_linear_srgb(adapt_white(xyz, white, linear_srgb_to_xyz({1.0, 1.0, 1.0})));
    }
    /// Of a share of the light at each band.
    template <typename Share>
    Rgb colour_of_share(const Share& share) const {
        std::vector<double> sent;
        for (std::size_t band = 0; band < light_.size(); ++band)
            sent.push_back(light_[band] * share(band));
        return colour(sent);
    }

private:
    Xyz seen(const std::vector<double>& values) const {
        Xyz sum{};
        for (std::size_t band = 0; band < values.size(); ++band)
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += weights_[band][k] * values[band];
        return sum;
    }

    std::vector<Xyz> weights_;
    std::vector<double> light_;
    Xyz white_{};
};

void add_layers(LampColours& colours, const Material& material, const std::vector<double>& nm,
                const LampEye& eye) {
    for (const Layer& layer : material.stack.layers)
        colours.layers.push_back({layer.ior(550.0), layer.alpha, layer.distribution,
                                  eye.colour_of_share([&](std::size_t band) {
                                      return std::exp(-layer.absorption(nm[band]) *
                                                      layer.thickness);
                                  })});
}

void add_substrate(LampColours& colours, const Material& material, const WavelengthGrid& bands,
                   const LampEye& eye) {
    const SubstrateValues values = measured_substrate(material.substrate, bands);
    colours.is_metal = !values.conductor.empty();
    colours.sigma = values.sigma;
    if (colours.is_metal) {
        colours.metal_alpha = material.substrate.conductor.alpha;
        colours.substrate = eye.colour_of_share(
            [&](std::size_t band) { return facet_reflectance(values.conductor[band], 1.0); });
        return;
    }
    const Eigen::Map<const Eigen::VectorXd> light(eye.light().data(), bands.count);
    const Eigen::VectorXd sent = values.matrix * light;
    colours.substrate = eye.colour({sent.begin(), sent.end()});
}

void say_what_is_left_out(LampColours& colours, const Material& material) {
    auto& out = colours.left_out;
    out.push_back("The colours are those under this lamp alone, seen by the observer of 1931 and "
                  "adapted to its white; another lamp needs another file.");
    out.push_back("Colours of layers and substrate multiply as three numbers, where spectra would "
                  "multiply band by band.");
    if (material.is_fluorescent())
        out.push_back("Re-radiation is in the colours, so that colours may exceed 1: it does not "
                      "follow the light that really falls on the surface.");
    if (material.stack.is_dispersive())
        out.push_back("Indices of refraction are those at 550 nm.");
    if (material.stack.has_films())
        out.push_back("Thin films are left out.");
    if (material.stack.has_flakes())
        out.push_back("Flakes are left out.");
    if (material.stack.scatters())
        out.push_back("Scattering in the layers is left out.");
}

} // namespace

void require_exchangeable(const Material& material) {
    viewed_models(material);
    if (material.stack.is_dyed())
        throw_input_error(material.position,
                          "files for other renderers cannot hold dyes in layers, whose light comes "
                          "from many depths",
                          "`view -o PAGE.html`, `render` and `measure` show them");
}

LampColours lamp_colours(const ViewedMaterial& viewed, const Lamp& lamp) {
    require_exchangeable(viewed.material);
    const WavelengthGrid bands = measured_bands(viewed.material, {});
    const LampEye eye(bands, lamp);
    LampColours colours;
    colours.material = viewed.name;
    colours.lamp = lamp.name;
    add_layers(colours, viewed.material, bands.centres_nm(), eye);
    add_substrate(colours, viewed.material, bands, eye);
    say_what_is_left_out(colours, viewed.material);
    return colours;
}

std::string exchange_head(const LampColours& colours, const std::string& what,
                          const std::string& comment) {
    // a name cannot end the comment that it stands in
    std::string name = colours.material + " under " + colours.lamp;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == '>'; }, ' ');
    for (std::size_t at; (at = name.find("--")) != std::string::npos;)
        name.replace(at, 2, "-");
    std::string head = fmt::format("{} {}: {}, written by reradiant view.\n", comment, name, what);
    head += fmt::format("{} Left out:\n", comment);
    for (const std::string& sentence : colours.left_out)
        head += fmt::format("{} - {}\n", comment, sentence);
    return head;
}

Rgb clipped(const Rgb& colour, const std::string& of, std::vector<std::string>& notes) {
    Rgb result = colour;
    for (double& value : result)
        value = std::clamp(value, 0.0, 1.0);
    if (std::fabs(result[0] - colour[0]) + std::fabs(result[1] - colour[1]) +
            std::fabs(result[2] - colour[2]) >
        1e-6)
        notes.push_back(fmt::format("{} is {:.4g}, {:.4g}, {:.4g} and was clipped to 0 to 1.", of,
                                    colour[0], colour[1], colour[2]));
    return result;
}

std::string identifier(const std::string& name) {
    std::string result;
    for (const char character : name)
        result += std::isalnum(static_cast<unsigned char>(character)) ? character : '_';
    return result.empty() || std::isdigit(static_cast<unsigned char>(result.front()))
               ? "material_" + result
               : result;
}

} // namespace reradiant
