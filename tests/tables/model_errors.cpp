// Every preset by the three models, as Markdown tables: how far weidlich-wilkie and adding are from
// the random walk in albedo and in the BRRDF, and how much energy each sends back. Arguments: names
// of presets; none: all of them.
#include "reradiant/measure.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"
#include "tests/support/statistics.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

using namespace reradiant;

namespace {

const WavelengthGrid bands{400, 40, 10};
const std::vector<double> albedo_angles{0, 20, 40, 60, 75, 85, 89};
constexpr long hemispherical_paths = 1L << 13U, directional_paths = 1L << 14U;
/// Paths at ten bands and seven angles: what is a standard error for all of them.
const double bound = test::sidak_bound(70 * 30);

/// Light that leaves per light of one excitation band, at all wavelengths, by geometry.
struct Sum {
    double value = 0.0, error = 0.0;
};
using Geometry = std::array<double, 4>; ///< theta_i, theta_o, phi, excitation nm
using Sums = std::map<Geometry, Sum>;

Sums sums_of(const Measurement& measurement) {
    Sums sums;
    for (const MeasureRow& row : measurement.rows) {
        Sum& sum = sums[{row.theta_i_deg, row.theta_o_deg, row.phi_deg, row.lambda_i_nm}];
        sum.value += row.value;
        sum.error = std::hypot(sum.error, row.standard_error);
    }
    return sums;
}

MeasureRequest request_for(Model model, bool hemispherical) {
    MeasureRequest request;
    request.model = model;
    request.bands = bands;
    request.hemispherical = hemispherical;
    request.samples = hemispherical ? hemispherical_paths : directional_paths;
    request.theta_i_deg = hemispherical ? albedo_angles : std::vector<double>{5, 45, 75};
    request.theta_o_deg = {0, 30, 60};
    request.phi_deg = {0, 90, 170};
    return request;
}

/// Measures a material by a model; returns nothing where the model refuses the material.
std::optional<Sums> measured(const Material& material, Model model, bool hemispherical) {
    try {
        return sums_of(measure_material(material, request_for(model, hemispherical)));
    } catch (const Error& error) {
        if (error.kind() != Error::Kind::Input)
            throw;
        return std::nullopt;
    }
}

/// Mean over bands and the largest value, and whether it creates no energy.
struct Albedo {
    double mean_at_0 = 0.0, largest = 0.0;
    bool conserves = true;
};
Albedo albedo_of(const Sums& sums) {
    Albedo albedo;
    for (const auto& [geometry, sum] : sums) {
        albedo.mean_at_0 += geometry[0] == 0.0 ? sum.value / bands.count : 0.0;
        albedo.largest = std::max(albedo.largest, sum.value);
        albedo.conserves = albedo.conserves && sum.value <= 1.0 + 1e-6 + bound * sum.error;
    }
    return albedo;
}

/// Over bands, by geometry: largest |model - walk| / walk.
double worst_error(const Sums& model, const Sums& walk) {
    std::map<std::array<double, 3>, std::array<double, 2>> means;
    for (const auto& [g, sum] : walk) {
        std::array<double, 2>& mean = means[{g[0], g[1], g[2]}];
        mean[0] += model.at(g).value;
        mean[1] += sum.value;
    }
    double worst = 0.0;
    for (const auto& [geometry, mean] : means)
        worst = mean[1] > 0.0 ? std::max(worst, std::fabs(mean[0] / mean[1] - 1.0)) : worst;
    return worst;
}

/// Largest relative standard error of the walk's mean over bands, which share their paths or at
/// least their random numbers: the mean of the errors.
double walk_uncertainty(const Sums& walk) {
    std::map<std::array<double, 3>, std::array<double, 2>> means;
    for (const auto& [g, sum] : walk) {
        std::array<double, 2>& mean = means[{g[0], g[1], g[2]}];
        mean[0] += sum.error;
        mean[1] += sum.value;
    }
    double worst = 0.0;
    for (const auto& [geometry, mean] : means)
        worst = mean[1] > 0.0 ? std::max(worst, mean[0] / mean[1]) : worst;
    return worst;
}

std::string percent(double value) {
    return fmt::format("{:.1f} %", 100.0 * value);
}

/// One preset: its row, and how many models create energy.
int print_preset(const std::string& name) {
    const Material material = load_material(spectra_directory() / "materials" / (name + ".toml"));
    const Sums walk = *measured(material, Model::Walk, true);
    const Sums walk_directions = *measured(material, Model::Walk, false);
    std::string row = fmt::format("| {} | {:.3f} ", name, albedo_of(walk).mean_at_0);
    std::string largest = fmt::format("{:.3f}", albedo_of(walk).largest);
    int creating = albedo_of(walk).conserves ? 0 : 1;
    for (const Model model : {Model::Adding, Model::WeidlichWilkie}) {
        const std::optional<Sums> own = measured(material, model, true);
        const std::optional<Sums> directions = measured(material, model, false);
        if (!own || !directions) {
            row += "| refused | | ";
            largest += " / -";
            continue;
        }
        const Albedo albedo = albedo_of(*own);
        row += fmt::format(
            "| {} | {} | {} ", percent(albedo.mean_at_0 / albedo_of(walk).mean_at_0 - 1.0),
            percent(worst_error(*own, walk)), percent(worst_error(*directions, walk_directions)));
        largest += fmt::format(" / {:.3f}{}", albedo.largest, albedo.conserves ? "" : " **over**");
        creating += albedo.conserves ? 0 : 1;
    }
    fmt::print("{}| {}, {} | {} |\n", row, percent(walk_uncertainty(walk)),
               percent(walk_uncertainty(walk_directions)), largest);
    std::fflush(stdout);
    return creating;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> names(argv + 1, argv + argc);
    if (names.empty())
        names = preset_names();
    fmt::print("Albedo: light of all wavelengths per light of one, mean over {} bands. \"All\" is "
               "the worst angle of the albedo up to 89 degrees, \"BRRDF\" the worst of 27 pairs of "
               "directions without mirror deltas.\n\n"
               "| preset | albedo at 0 deg, walk | adding: albedo at 0 | all | BRRDF | "
               "weidlich-wilkie: albedo at 0 | all | BRRDF | s.e. of the walk: albedo, BRRDF | "
               "largest albedo: walk / adding / weidlich-wilkie |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
               bands.count);
    int creating = 0;
    for (const std::string& name : names)
        creating += print_preset(name);
    fmt::print("\n{} models of presets create energy\n", creating);
    return creating > 0 ? 3 : 0;
}
