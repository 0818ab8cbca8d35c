#include "tests/tables/dye_recovery_cases.h"

#include "host/fit/synth/synth_band.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Vector = Eigen::VectorXd;

/// One like fluorescein, and one that takes up and sends out longer waves.
SlabDye true_dye(int k, double depth) {
    if (k == 0)
        return {spectrum_of_bands({{.peak_nm = 480, .width_per_cm = 2200, .skew = 0.7}}, depth),
                1.0, spectrum_of_bands({{.peak_nm = 520, .width_per_cm = 1800, .skew = 1.4}}, 1.0),
                0.8, nullptr};
    return {spectrum_of_bands({{.peak_nm = 540, .width_per_cm = 2000, .skew = 0.7}}, depth), 1.0,
            spectrum_of_bands({{.peak_nm = 590, .width_per_cm = 1600, .skew = 1.3}}, 1.0), 0.6,
            nullptr};
}

double covered_share(const Vector& value, const Vector& sigma, const Vector& truth) {
    constexpr double seen_of_peak = 0.01, normal_95 = 1.96;
    double count = 0.0, within = 0.0;
    for (Eigen::Index k = 0; k < truth.size(); ++k) {
        if (truth(k) < seen_of_peak * truth.maxCoeff())
            continue;
        count += 1.0;
        within += std::fabs(value(k) - truth(k)) <= normal_95 * sigma(k) ? 1.0 : 0.0;
    }
    return within / count;
}

double rms_of_peak(const Vector& value, const Vector& truth) {
    return (value - truth).norm() / std::sqrt(static_cast<double>(truth.size())) / truth.maxCoeff();
}

bool holds(const BandedNumber& number, double truth) {
    constexpr double rounding = 1e-9;
    return number.low <= truth + rounding && number.high >= truth - rounding;
}

} // namespace

SynthRecipe dye_recipe(const DyeCase& what, double depth) {
    SynthRecipe recipe;
    recipe.emission = grid_from_range(380.0, 780.0, 10.0);
    recipe.excitation = grid_from_range(300.0, 780.0, 10.0);
    recipe.reflectance = Spectrum::constant(what.reflectance);
    Layer layer;
    layer.alpha = what.alpha;
    layer.thickness = depth; // of dyes whose absorption is 1 at the peak
    for (int k = 0; k < what.dyes; ++k)
        layer.dyes.push_back(true_dye(k, 1.0));
    recipe.stack.layers = {layer};
    recipe.geometries = {{45.0, 0.0, 0.0}};
    recipe.noise.read_of_peak = what.noise_of_peak;
    return recipe;
}

DyeFitSettings dye_settings(const DyeCase& what) {
    DyeFitSettings settings;
    settings.material.stack = dye_recipe(what, what.depths.front()).stack;
    settings.material.substrate.reflectance = Spectrum::constant(what.reflectance);
    settings.dyes = what.dyes;
    settings.thickness = what.depths;
    return settings;
}

DyeError dye_error(const DyeCase& what, const DyeFitResult& result, int k) {
    const SlabDye dye = true_dye(k, 1.0);
    Vector absorption(result.bands.count), emission(result.bands.count);
    for (int band = 0; band < result.bands.count; ++band) {
        absorption(band) = dye.absorption(result.bands.centre_nm(band));
        emission(band) = dye.emission.average(result.bands.lower_edge_nm(band),
                                              result.bands.upper_edge_nm(band));
    }
    emission /= emission.sum() * result.bands.step_nm;
    const auto& found = *std::ranges::min_element(result.dyes, {}, [&](const FittedDye& other) {
        return (other.emission - emission).norm();
    });
    const double depth = *std::ranges::max_element(what.depths);
    return {found.quantum_yield.value / dye.quantum_yield - 1.0,
            found.peak_depth.value / depth - 1.0,
            rms_of_peak(found.absorption, absorption),
            rms_of_peak(found.emission, emission),
            0.5 * (covered_share(found.absorption, found.absorption_sigma, absorption) +
                   covered_share(found.emission, found.emission_sigma, emission)),
            holds(found.quantum_yield, dye.quantum_yield),
            holds(found.peak_depth, depth)};
}

} // namespace reradiant
