#pragma once

#include "reradiant/reradiation.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace reradiant {

/// A `SyntheticRecipe` says how one of the matrices in spectra/reradiation was made: one
/// fluorophore with a skewed emission band (two half Gaussians), an absorption that ends in a
/// logistic edge, and a reflectance that takes no light the fluorophore has taken.
struct SyntheticRecipe {
    std::string file;
    double emission_peak_nm, sigma_blue_nm, sigma_red_nm;
    double absorptance, absorption_edge_nm, absorption_width_nm;
    double quantum_yield;
    double dark_reflectance, bright_reflectance, reflectance_edge_nm, reflectance_width_nm;
    double reflectance_end_nm; ///< where the reflectance falls again; 0: it stays
};

inline std::vector<SyntheticRecipe> synthetic_recipes() {
    return {{"synthetic-orange.csv", 600, 18, 40, 0.88, 562, 8, 0.9, 0.04, 0.84, 585, 8, 0},
            {"synthetic-green.csv", 520, 13, 30, 0.90, 492, 8, 0.85, 0.04, 0.62, 512, 8, 575}};
}

inline Spectrum tabulated(const std::function<double(double)>& f) {
    std::vector<double> nm, value;
    for (int l = 290; l <= 950; ++l) {
        nm.push_back(l);
        value.push_back(f(l));
    }
    return Spectrum::table(nm, value);
}

inline double logistic(double x) {
    return 1.0 / (1.0 + std::exp(-x));
}

inline Fluorophore fluorophore_of(const SyntheticRecipe& r) {
    const auto emission = [&r](double l) {
        const double t =
            (l - r.emission_peak_nm) / (l < r.emission_peak_nm ? r.sigma_blue_nm : r.sigma_red_nm);
        return std::exp(-0.5 * t * t);
    };
    const auto absorption = [&r](double l) {
        return r.absorptance * logistic((r.absorption_edge_nm - l) / r.absorption_width_nm);
    };
    return {tabulated(absorption), tabulated(emission), r.quantum_yield};
}

inline Spectrum reflectance_of(const SyntheticRecipe& r) {
    return tabulated([&r](double l) {
        double bright = logistic((l - r.reflectance_edge_nm) / r.reflectance_width_nm);
        if (r.reflectance_end_nm > 0.0)
            bright *= logistic((r.reflectance_end_nm - l) / 15.0);
        return r.dark_reflectance + (r.bright_reflectance - r.dark_reflectance) * bright;
    });
}

inline ReradiationMatrix synthetic_matrix(const SyntheticRecipe& r) {
    const WavelengthGrid grid{300.0, 10.0, 49};
    return matrix_from_fluorophores({fluorophore_of(r)}, reflectance_of(r), grid, grid);
}

} // namespace reradiant
