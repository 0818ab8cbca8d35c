#include "host/render/plan/light_layer_plan.h"

#include "host/film/lamp_cells.h"
#include "host/render/plan/light_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

namespace reradiant {

namespace {

/// Light below is ultraviolet: cells of the comb belong to the side that their centres are on.
constexpr double ultraviolet_below_nm = 400.0;

bool fluoresces(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return material.is_fluorescent(); });
}

bool is_constant_environment(const Light& light) {
    const auto* sky = std::get_if<EnvironmentLight>(&light);
    return sky != nullptr && sky->image < 0;
}

/// Lights of one group, by their indices.
struct LightGroup {
    std::string name;
    std::vector<std::size_t> lights;
};

std::vector<LightGroup> light_groups(const Scene& scene) {
    std::vector<LightGroup> groups;
    const std::vector<std::string> names = light_group_names(scene);
    for (std::size_t i = 0; i < names.size(); ++i) {
        auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const LightGroup& g) { return g.name == names[i]; });
        if (group == groups.end())
            group = groups.insert(groups.end(), {names[i], {}});
        group->lights.push_back(i);
    }
    return groups;
}

/// The spectrum that the lights share, if they differ by a factor at most.
std::vector<double> shared_lamp(const Scene& scene, const LightGroup& group) {
    constexpr double tolerance = 1e-6; ///< of the largest value
    std::vector<double> shared;
    for (const std::size_t i : group.lights) {
        std::vector<double> lamp = lamp_cell_means(light_spectrum(scene.lights[i]));
        const double largest = *std::max_element(lamp.begin(), lamp.end());
        if (!(largest > 0.0))
            continue;
        if (shared.empty())
            shared = lamp;
        const double scale = *std::max_element(shared.begin(), shared.end()) / largest;
        for (std::size_t cell = 0; cell < lamp.size(); ++cell)
            if (std::abs(lamp[cell] * scale - shared[cell]) > tolerance * largest * scale)
                return {};
    }
    return shared;
}

/// Returns the lanes of every light as far as it is of the group. Constant environments are
/// rendered as one, which stands for those of the group.
std::vector<std::vector<float>> spectra_of(const Scene& scene, const LightGroup& group,
                                           const WavelengthPlan& wavelengths,
                                           const LightPlan& lights) {
    std::vector<std::vector<float>> spectra(scene.lights.size());
    Spectrum sky;
    for (const std::size_t i : group.lights)
        if (is_constant_environment(scene.lights[i]))
            sky += light_spectrum(scene.lights[i]);
        else
            spectra[i] = lights.lights[i].lanes;
    if (lights.environment != NO_INDEX)
        spectra[lights.environment] = plain_spectrum(sky, wavelengths).lanes;
    return spectra;
}

/// Clears what lies outside cells [first, end) of the comb; returns whether anything is left.
bool keep_cells(std::vector<std::vector<float>>& spectra, const WavelengthPlan& wavelengths,
                int first, int end) {
    const auto padded = static_cast<std::size_t>(wavelengths.padded_lanes());
    bool any = false;
    for (std::vector<float>& lanes : spectra)
        for (std::size_t k = 0; k < lanes.size(); ++k) {
            const std::size_t lane = k % padded;
            const int cell =
                lane < wavelengths.lanes.size() ? wavelengths.lanes[lane].cell : end; // padding
            if (cell < first || cell >= end)
                lanes[k] = 0.0f;
            any = any || lanes[k] != 0.0f;
        }
    return any;
}

} // namespace

std::vector<std::string> light_group_names(const Scene& scene) {
    constexpr const char* types[] = {"rectangle",   "sphere", "point", "directional",
                                     "environment", "spot",   "disk",  "mesh"};
    static_assert(std::size(types) == std::variant_size_v<Light>);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const bool is_named = i < scene.light_groups.size() && !scene.light_groups[i].empty();
        names.push_back(is_named ? scene.light_groups[i]
                                 : fmt::format("{}:{}", types[scene.lights[i].index()], i + 1));
    }
    return names;
}

std::uint64_t most_light_layers(const Scene& scene) {
    return light_groups(scene).size() * (fluoresces(scene) ? 2 : 1);
}

std::vector<LightLayerPlan> plan_light_layers(const Scene& scene, const WavelengthPlan& wavelengths,
                                              const LightPlan& lights) {
    const WavelengthGrid& comb = wavelengths.comb;
    int split = 0;
    while (split < comb.count && comb.centre_nm(split) < ultraviolet_below_nm)
        ++split;
    struct Part {
        LightPart part;
        int first, end;
    };
    const std::vector<Part> parts = fluoresces(scene)
                                        ? std::vector<Part>{{LightPart::Ultraviolet, 0, split},
                                                            {LightPart::Visible, split, comb.count}}
                                        : std::vector<Part>{{LightPart::Whole, 0, comb.count}};
    std::vector<LightLayerPlan> layers;
    for (const LightGroup& group : light_groups(scene)) {
        const std::vector<double> lamp = shared_lamp(scene, group);
        for (const Part& part : parts) {
            LightLayerPlan planned{{group.name,
                                    part.part,
                                    comb.lower_edge_nm(part.first),
                                    comb.lower_edge_nm(part.end),
                                    lamp,
                                    {}},
                                   spectra_of(scene, group, wavelengths, lights)};
            if (keep_cells(planned.spectra, wavelengths, part.first, part.end))
                layers.push_back(std::move(planned));
        }
    }
    return layers;
}

} // namespace reradiant
