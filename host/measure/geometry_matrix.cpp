#include "host/measure/geometry_matrix.h"

#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/slab_emission.h"
#include "host/layers/walk/walk_estimate.h"
#include "host/measure/measure_memory.h"
#include "host/measure/measure_substrate.h"
#include "host/measure/walk_measurement.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/model_choice.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace reradiant {

namespace {

using Kind = ViewingGeometry::Kind;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

[[noreturn]] void refuse(const std::string& text) {
    throw std::invalid_argument(fmt::format(
        "there is no geometry '{}'; there are 45/0, 0/45, 8/d, d/8 (specular included), 8/de, de/8 "
        "(excluded), and THETA_I:THETA_O[:PHI] in degrees, thetas from 0 to below 90",
        text));
}

std::vector<double> angles(const std::string& text) {
    std::vector<double> result;
    const char *at = text.data(), *const end = at + text.size();
    while (true) {
        double value = 0.0;
        const auto [stop, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value))
            refuse(text);
        result.push_back(value);
        if (stop == end)
            return result;
        if (*stop != ':')
            refuse(text);
        at = stop + 1;
    }
}

void require_above_horizon(const std::string& text, double theta_i, double theta_o) {
    const auto is_above = [](double theta) { return theta >= 0.0 && theta < 90.0; };
    if (is_above(theta_i) && theta_o > 90.0 && theta_o <= 180.0)
        throw std::invalid_argument(
            fmt::format("'{}' looks at the far side, from {:g} degrees: colours are of what is "
                        "reflected, `measure` has what sheets transmit; thetas are from 0 to "
                        "below 90",
                        text, theta_o));
    for (const double theta : {theta_i, theta_o})
        if (!is_above(theta))
            throw std::invalid_argument(
                fmt::format("'{}' has a direction of {:g} degrees from the normal, which is {}; "
                            "thetas are from 0 to below 90",
                            text, theta, theta < 0.0 ? "negative" : "on or below the horizon"));
}

/// What goes into the port of the light that interfaces, flakes and a conductor reflect, unit 1:
/// Simpson's rule over the cone around the mirror's direction. The rings lie closer towards its
/// axis, where narrow lobes have their peak.
double into_port(const StackBsdf& band, double theta) {
    constexpr int rings = 64, sectors = 32;
    const kernels::Vec3 wi = direction_at(std::cos(theta), 0.0);
    double sum = 0.0;
    for (int ring = 1; ring <= rings; ++ring) {
        const double u = static_cast<double>(ring) / rings;
        const double off = radians(specular_port_deg) * u * u * u;
        const double weight = (ring == rings ? 1.0 : ring % 2 == 1 ? 4.0 : 2.0) * 3.0 * u * u;
        for (int sector = 0; sector < sectors; ++sector) {
            const double turn = 2.0 * std::numbers::pi * (sector + 0.5) / sectors;
            const double x = std::sin(off) * std::cos(turn), y = std::sin(off) * std::sin(turn);
            const double cos_o = std::cos(off) * std::cos(theta) + x * std::sin(theta);
            const double away = std::cos(off) * std::sin(theta) - x * std::cos(theta);
            const kernels::Vec3 wo = direction_at(cos_o, std::atan2(y, -away));
            sum +=
                weight * std::sin(off) * cos_o * (band.specular(wi, wo) + band.conductor(wi, wo));
        }
    }
    return sum * radians(specular_port_deg) / (3.0 * rings) * 2.0 * std::numbers::pi / sectors;
}

/// All that is reflected of light from one direction, the mirror's reflection with it.
Eigen::MatrixXd reflected(const LayeredBsdf& surface, const AirDirection& from) {
    const LayeredBsdf::Parts parts = surface.albedo(from, from.side);
    return parts.diffuse + parts.slab + Eigen::MatrixXd(parts.specular.asDiagonal());
}

/// Light that comes from everywhere and is seen in one direction runs backwards, with excitation
/// and emission of the substrate exchanged, but that of dyes, which is solved for as it comes.
Eigen::MatrixXd by_closed_model(const Material& material, SubstrateValues substrate,
                                const WavelengthGrid& bands, const ViewingGeometry& geometry,
                                Model model) {
    const bool is_diffusely_lit = geometry.kind == Kind::HemisphericalDirectional;
    const bool runs_backwards = is_diffusely_lit && !material.stack.is_dyed();
    if (runs_backwards)
        substrate.matrix.transposeInPlace();
    const LayeredBsdf surface(material.stack, substrate, bands, closed_model(model));
    const double theta = radians(geometry.theta_i_deg);
    if (geometry.kind == Kind::Directional)
        return std::numbers::pi * surface.eval(direction_at(std::cos(theta), 0.0),
                                               direction_at(std::cos(radians(geometry.theta_o_deg)),
                                                            radians(geometry.phi_deg)));
    const AirDirection at{std::cos(theta), Side::Above};
    Eigen::MatrixXd values =
        is_diffusely_lit && !runs_backwards ? surface.diffusely_lit(at) : reflected(surface, at);
    for (int band = 0; band < bands.count && !geometry.specular_included; ++band)
        values(band, band) -=
            surface.at(band).delta(at.cosine) + into_port(surface.unscattered_at(band), theta);
    return runs_backwards ? Eigen::MatrixXd(values.transpose()) : values;
}

/// By reciprocity, light that comes from everywhere and is seen at 8 degrees is light that comes at
/// 8 degrees, runs backwards and goes everywhere, with excitation and emission exchanged.
Eigen::MatrixXd by_walk(const Material& material, const SubstrateValues& substrate,
                        const WavelengthGrid& bands, const ViewingGeometry& geometry) {
    if (!geometry.specular_included)
        throw_input_error({},
                          "specular light is excluded by closed models only, and this material is "
                          "walked",
                          "ask for --geometry 8/d or 45/0");
    const LayerWalk forwards(material.stack, substrate, bands.centres_nm(),
                             slab_emissions(material.stack, bands));
    const bool is_backwards = geometry.kind == Kind::HemisphericalDirectional;
    const bool is_directional = geometry.kind == Kind::Directional;
    const kernels::Vec3 wi = direction_at(std::cos(radians(geometry.theta_i_deg)), 0.0);
    const kernels::Vec3 wo =
        direction_at(std::cos(radians(geometry.theta_o_deg)), radians(geometry.phi_deg));
    const WalkTally mean = estimate_walk(is_backwards ? forwards.reversed() : forwards, wi,
                                         {&wo, is_directional ? 1U : 0U}, default_walk_samples, 0)
                               .mean;
    if (is_directional)
        return std::numbers::pi * all_light(mean.directional[0]);
    return is_backwards ? all_light(mean.hemispherical).transpose() : all_light(mean.hemispherical);
}

} // namespace

ViewingGeometry viewing_geometry(const std::string& text) {
    if (text == "45/0")
        return {};
    if (text == "0/45")
        return {.theta_i_deg = 0.0, .theta_o_deg = 45.0, .name = text};
    if (text == "8/d" || text == "8/de")
        return {.kind = Kind::DirectionalHemispherical,
                .theta_i_deg = 8.0,
                .specular_included = text == "8/d",
                .name = text};
    if (text == "d/8" || text == "de/8")
        return {.kind = Kind::HemisphericalDirectional,
                .theta_i_deg = 8.0,
                .specular_included = text == "d/8",
                .name = text};
    const std::vector<double> given = angles(text);
    if (given.size() < 2 || given.size() > 3)
        refuse(text);
    require_above_horizon(text, given[0], given[1]);
    return {.theta_i_deg = given[0],
            .theta_o_deg = given[1],
            .phi_deg = given.size() > 2 ? given[2] : 0.0,
            .name = text};
}

ReradiationMatrix geometry_matrix(const Material& material, const ViewingGeometry& geometry) {
    const ModelChoice choice = choose_model(material, Model::Auto, ModelUse::Measure);
    const WavelengthGrid bands = measured_bands(material, {});
    check_measure_memory(material, bands, {});
    const SubstrateValues substrate = measured_substrate(material.substrate, bands);
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = bands;
    matrix.values = choice.model == Model::Walk
                        ? by_walk(material, substrate, bands, geometry)
                        : by_closed_model(material, substrate, bands, geometry, choice.model);
    matrix.geometry = geometry.name;
    return matrix;
}

ReradiationMatrix geometry_matrix_of(const std::filesystem::path& file, const Material& material,
                                     const ViewingGeometry& geometry) {
    try {
        return geometry_matrix(material, geometry);
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Input && error.position().file.empty())
            throw_input_error({file.string()}, error.what());
        throw;
    }
}

} // namespace reradiant
