#include "tests/tables/recovery_cases.h"

#include "host/fit/synth/synth_band.h"

#include <array>
#include <cmath>

namespace reradiant {

namespace {

constexpr double pale_reflectance = 0.9;

struct Dye {
    WavenumberBand excitation, emission;
    double quantum_yield;
};

/// Blue, green, orange and red: neighbours overlap in excitation and in emission.
std::array<Dye, 4> dyes() {
    return {Dye{{.peak_nm = 520, .width_per_cm = 2600, .skew = 0.7},
                {.peak_nm = 590, .width_per_cm = 1700, .skew = 1.3},
                0.9},
            {{.peak_nm = 370, .width_per_cm = 4200, .skew = 0.8},
             {.peak_nm = 440, .width_per_cm = 3000, .skew = 1.4},
             0.7},
            {{.peak_nm = 450, .width_per_cm = 3000, .skew = 0.7},
             {.peak_nm = 515, .width_per_cm = 2000, .skew = 1.4},
             0.8},
            {{.peak_nm = 590, .width_per_cm = 2200, .skew = 0.6},
             {.peak_nm = 660, .width_per_cm = 1500, .skew = 1.2},
             0.6}};
}

/// Returns the share of light that the dyes leave, times the substrate's own reflectance.
Spectrum remaining(const std::vector<Fluorophore>& fluorophores) {
    std::vector<double> nm, value;
    for (double l = 290.0; l <= 790.0; l += 1.0) {
        double left = 1.0;
        for (const Fluorophore& fluorophore : fluorophores)
            left -= fluorophore.excitation(l);
        nm.push_back(l);
        value.push_back(pale_reflectance * left);
    }
    return Spectrum::table(std::move(nm), std::move(value));
}

Layer layer_of(RecoveryStack stack) {
    Layer layer;
    if (stack == RecoveryStack::Rough)
        layer.alpha = 0.3;
    if (stack == RecoveryStack::Absorbing)
        layer.absorption = Spectrum::table({300, 400, 500, 780}, {0.5, 0.3, 0.1, 0.02});
    return layer;
}

/// Returns the photons emitted over the photons absorbed.
double overall_quantum_yield(const ReradiationMatrix& matrix) {
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    const double steps = matrix.emission.step_nm / matrix.excitation.step_nm;
    double emitted = 0.0, absorbed = 0.0;
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        if (diagonal < 0)
            continue;
        absorbed += 1.0 - matrix.values(diagonal, i);
        for (int o = 0; o < matrix.emission.count; ++o)
            emitted += steps * fluorescence(o, i) * matrix.emission.centre_nm(o) /
                       matrix.excitation.centre_nm(i);
    }
    return emitted / absorbed;
}

} // namespace

const char* recovery_stack_name(RecoveryStack stack) {
    switch (stack) {
    case RecoveryStack::Bare:
        return "bare";
    case RecoveryStack::Smooth:
        return "smooth";
    case RecoveryStack::Rough:
        return "rough";
    case RecoveryStack::Absorbing:
        return "absorbing";
    }
    return "";
}

SynthRecipe recovery_recipe(const RecoveryCase& wanted) {
    SynthRecipe recipe;
    recipe.emission = grid_from_range(380.0, 780.0, wanted.step_nm);
    recipe.excitation = grid_from_range(300.0, 780.0, wanted.step_nm);
    // So much of each that all four together absorb 0.88 of the light at most.
    const double absorptance = wanted.fluorophores == 1 ? 0.85 : 0.7;
    for (int k = 0; k < wanted.fluorophores; ++k) {
        const Dye dye = dyes()[static_cast<std::size_t>(k)];
        recipe.fluorophores.push_back({spectrum_of_bands({dye.excitation}, absorptance),
                                       spectrum_of_bands({dye.emission}, 1.0), dye.quantum_yield});
    }
    recipe.reflectance = remaining(recipe.fluorophores);
    if (wanted.stack != RecoveryStack::Bare) {
        recipe.stack.layers = {layer_of(wanted.stack)};
        recipe.geometries = {{0.0, 45.0, 90.0}, {45.0, 10.0, 90.0}};
    }
    recipe.noise.read_of_peak = wanted.noise_of_peak;
    return recipe;
}

RecoveryError recovery_error(const ReradiationMatrix& truth, const ReradiationMatrix& fitted,
                             const Eigen::MatrixXd& sigma, bool was_covered) {
    constexpr double seen_of_peak = 0.01, normal_quantile_95 = 1.96;
    const double peak = truth.fluorescent_part().maxCoeff();
    double squares = 0.0, entries = 0.0, large = 0.0, covered = 0.0;
    double guessed_squares = 0.0, guessed_entries = 0.0;
    for (int i = 0; i < truth.excitation.count; ++i)
        for (int o = 0; o < truth.emission.count; ++o) {
            if (!(truth.emission.centre_nm(o) > truth.excitation.centre_nm(i)))
                continue;
            const double error = fitted.values(o, i) - truth.values(o, i);
            const bool is_guessed = was_covered && diagonal_row(truth, i) < 0;
            (is_guessed ? guessed_squares : squares) += error * error;
            (is_guessed ? guessed_entries : entries) += 1.0;
            if (truth.values(o, i) < seen_of_peak * peak)
                continue;
            large += 1.0;
            covered += std::abs(error) <= normal_quantile_95 * sigma(o, i) ? 1.0 : 0.0;
        }
    const double yield = overall_quantum_yield(truth);
    return {std::sqrt(squares / entries) / peak,
            guessed_entries > 0.0 ? std::sqrt(guessed_squares / guessed_entries) / peak : 0.0,
            covered / large, (overall_quantum_yield(fitted) - yield) / yield};
}

} // namespace reradiant
