#include "host/render/plan/light_plan.h"

#include "host/render/tables/environment_tables.h"
#include "host/spectral/colour/rgb_basis.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace reradiant {

namespace {

/// Of a mesh light's triangle in the tables: a share of the area and three corners.
constexpr std::uint64_t FLOATS_A_TRIANGLE = 10;

/// Lanes of a light's spectrum: sub-cell means on the comb (so that no power is lost between
/// phases), values at the centres with a single phase; a line's power on its own lanes.
double lane_value(const Spectrum& spectrum, const Spectrum& on_comb, const WavelengthPlan& plan,
                  int lane, int phase) {
    const auto [from, to] = plan.interval_nm(lane, phase);
    if (!plan.lanes[static_cast<std::size_t>(lane)].is_line)
        return plan.phases == 1 ? on_comb(plan.wavelength_nm(lane, phase))
                                : on_comb.average(from, to);
    double power = 0.0;
    for (const SpectralLine& line : spectrum.lines())
        if (plan.stands_apart(line) &&
            std::abs(0.5 * (from + to) - line.centre_nm) < 0.5 * line.width_nm)
            power += line.integral * (to - from) / line.width_nm;
    return power;
}

/// Appends a spectrum times a smooth factor, [phase][lane]; returns the mean value over lanes.
double append_spectrum(const Spectrum& spectrum, const Spectrum& factor, const WavelengthPlan& plan,
                       std::vector<float>& to) {
    Spectrum on_comb = spectrum.without_lines();
    for (const SpectralLine& line : spectrum.lines())
        if (!plan.stands_apart(line))
            on_comb += Spectrum::line(line.centre_nm, line.width_nm, line.integral);
    const int lanes = static_cast<int>(plan.lanes.size());
    double sum = 0.0;
    for (int phase = 0; phase < plan.phases; ++phase)
        for (int lane = 0; lane < plan.padded_lanes(); ++lane) {
            const double value = lane < lanes ? lane_value(spectrum, on_comb, plan, lane, phase) *
                                                    factor(plan.wavelength_nm(lane, phase))
                                              : 0.0;
            to.push_back(static_cast<float>(value));
            const bool is_line = lane < lanes && plan.lanes[static_cast<std::size_t>(lane)].is_line;
            sum += is_line ? value / plan.comb.step_nm : value;
        }
    return sum / (plan.phases * plan.comb.count);
}

/// Returns the spectra that red, green and blue of an environment's image stand for.
LightSpectrum image_spectrum(const EnvironmentLight& sky, const Image& image,
                             const WavelengthPlan& wavelengths) {
    LightSpectrum light;
    const double brightness = mean_over_sphere(image);
    if (!(brightness > 0.0))
        return light; // black: nothing to sample
    const auto& basis = rgb_basis();
    const std::span<const Spectrum> primaries =
        sky.primaries.empty() ? std::span<const Spectrum>(basis) : sky.primaries;
    for (const Spectrum& primary : primaries)
        light.mean += append_spectrum(sky.radiance, primary, wavelengths, light.lanes) / 3.0;
    light.mean *= brightness;
    return light;
}

/// Returns the sum of all constant environments, which are rendered as one.
Spectrum constant_environment(const Scene& scene) {
    Spectrum sum;
    for (const Light& light : scene.lights)
        if (const auto* sky = std::get_if<EnvironmentLight>(&light); sky && sky->image < 0)
            sum += sky->radiance;
    return sum;
}

RenderFeatures features_of(const Light& light) {
    RenderFeatures features;
    const auto* sky = std::get_if<EnvironmentLight>(&light);
    features.environment_image = sky != nullptr && sky->image >= 0;
    features.environment = sky != nullptr && sky->image < 0;
    const auto* directional = std::get_if<DirectionalLight>(&light);
    features.distant_lights = directional != nullptr && directional->angle_deg > 0.0;
    features.delta_lights = std::holds_alternative<PointLight>(light) ||
                            (directional != nullptr && !features.distant_lights);
    features.spot_lights = std::holds_alternative<SpotLight>(light);
    features.shaped_lights =
        std::holds_alternative<DiskLight>(light) || std::holds_alternative<MeshLight>(light);
    features.area_lights = features.shaped_lights ||
                           std::holds_alternative<RectangleLight>(light) ||
                           std::holds_alternative<SphereLight>(light);
    return features;
}

/// Plans the layers, and counts their floats.
void add_layers(LightPlan& plan, const Scene& scene, const WavelengthPlan& wavelengths) {
    plan.layers = plan_light_layers(scene, wavelengths, plan);
    plan.floats += plan.dark_floats();
    for (const LightLayerPlan& layer : plan.layers)
        for (const std::vector<float>& lanes : layer.spectra)
            plan.floats += lanes.size();
}

} // namespace

LightSpectrum plain_spectrum(const Spectrum& spectrum, const WavelengthPlan& wavelengths) {
    LightSpectrum light;
    light.mean = append_spectrum(spectrum, Spectrum::constant(1.0), wavelengths, light.lanes);
    return light;
}

std::size_t LightPlan::dark_floats() const {
    std::size_t most = 0;
    for (const LightSpectrum& light : lights)
        most = std::max(most, light.lanes.size());
    return layers.empty() ? 0 : most;
}

RenderFeatures features_of_lights(const Scene& scene) {
    RenderFeatures features;
    for (const Light& light : scene.lights)
        features.add(features_of(light));
    return features;
}

LightPlan plan_lights(const Scene& scene, const WavelengthPlan& wavelengths, bool with_layers) {
    LightPlan plan;
    for (const Light& light : scene.lights) {
        RenderFeatures features = features_of(light);
        const auto* sky = std::get_if<EnvironmentLight>(&light);
        if (features.environment_image) {
            const Image& image = scene.images[static_cast<std::size_t>(sky->image)];
            plan.lights.push_back(image_spectrum(*sky, image, wavelengths));
            features.environment_image = !plan.lights.back().lanes.empty();
            if (features.environment_image)
                plan.floats += environment_image_floats(image);
        } else {
            plan.lights.push_back(plain_spectrum(features.environment ? constant_environment(scene)
                                                                      : light_spectrum(light),
                                                 wavelengths));
            features.environment = features.environment && plan.lights.back().mean > 0.0;
        }
        if (features.environment && plan.environment == NO_INDEX)
            plan.environment = static_cast<std::uint32_t>(plan.lights.size() - 1);
        if (const auto* mesh = std::get_if<MeshLight>(&light))
            plan.floats += FLOATS_A_TRIANGLE * (mesh->mesh.indices.size() / 3);
        plan.floats += plan.lights.back().lanes.size();
        plan.features.add(features);
    }
    if (with_layers)
        add_layers(plan, scene, wavelengths);
    return plan;
}

} // namespace reradiant
