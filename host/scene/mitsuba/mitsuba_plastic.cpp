#include "host/scene/mitsuba/mitsuba_scene.h"
#include "reradiant/colour.h"
#include "reradiant/stack_model.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr double step_nm = 5.0;

std::vector<double> doubles(const toml::array& array) {
    std::vector<double> numbers;
    for (const toml::node& node : array)
        numbers.push_back(node.value_or(0.0));
    return numbers;
}

/// Nodes of the spectrum and every 5 nm between, since the mapped one is curved.
std::vector<double> fine_nodes(const Spectrum& spectrum) {
    std::vector<double> nodes = spectrum.breakpoints_nm();
    if (nodes.empty()) // a constant
        return {550.0};
    const double first = nodes.front(), last = nodes.back();
    for (double nm = std::ceil(first / step_nm) * step_nm; nm < last; nm += step_nm)
        nodes.push_back(nm);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

template <class Map>
toml::table mapped(const Spectrum& spectrum, const Map& map) {
    toml::array nm, value;
    for (const double at : fine_nodes(spectrum)) {
        nm.push_back(at);
        value.push_back(map(spectrum(at)));
    }
    return toml::table{{"nm", std::move(nm)}, {"value", std::move(value)}};
}

/// The share r of the light from the base that the coat sends back.
double internal_reflectance(const toml::table& layer) {
    SurfaceValues coat;
    coat.ior_below = layer["ior"].value_or(1.0);
    coat.alpha = layer["alpha"].value_or(0.0);
    coat.distribution = layer["distribution"].value_or(std::string()) == "beckmann"
                            ? Distribution::Beckmann
                            : Distribution::Ggx;
    coat.scattering = Scattering::Single;
    return adding_transport({coat, SlabValues{coat.ior_below}})->internal_reflectance();
}

} // namespace

bool take_linear_plastic(toml::table& substrate, const toml::table& layer) {
    const double r = internal_reflectance(layer);
    const auto map = [r](double reflectance) { return reflectance / (1.0 - r + r * reflectance); };
    toml::node& given = *substrate.get("reflectance");
    if (const auto number = given.value<double>()) {
        substrate.insert_or_assign("reflectance", map(*number));
        return true;
    }
    const toml::table& form = *given.as_table();
    if (const toml::array* rgb = form["rgb"].as_array()) {
        const auto c = doubles(*rgb);
        substrate.insert_or_assign("reflectance",
                                   mapped(reflectance_from_rgb({c[0], c[1], c[2]}), map));
        return true;
    }
    const toml::array *nm = form["nm"].as_array(), *value = form["value"].as_array();
    if (nm == nullptr || value == nullptr)
        return false;
    substrate.insert_or_assign("reflectance",
                               mapped(Spectrum::table(doubles(*nm), doubles(*value)), map));
    return true;
}

} // namespace reradiant
