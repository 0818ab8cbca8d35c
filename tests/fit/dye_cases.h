#pragma once

#include "host/fit/dye/dye_response.h"
#include "host/fit/synth/synth_band.h"
#include "host/layers/stack/slab_emission.h"

#include <utility>

namespace reradiant {

/// A dye like fluorescein, of some optical depth at its peak, in a layer of thickness 1.
inline SlabDye green_dye(double depth, double quantum_yield) {
    return {spectrum_of_bands({{.peak_nm = 480, .width_per_cm = 2200, .skew = 0.7}}, depth), 1.0,
            spectrum_of_bands({{.peak_nm = 520, .width_per_cm = 1800, .skew = 1.4}}, 1.0),
            quantum_yield, nullptr};
}

/// One that takes up and sends out longer waves.
inline SlabDye orange_dye(double depth, double quantum_yield) {
    return {spectrum_of_bands({{.peak_nm = 540, .width_per_cm = 2000, .skew = 0.7}}, depth), 1.0,
            spectrum_of_bands({{.peak_nm = 590, .width_per_cm = 1600, .skew = 1.3}}, 1.0),
            quantum_yield, nullptr};
}

inline const WavelengthGrid dye_bands = grid_from_range(300.0, 780.0, 10.0);

inline Eigen::VectorXd on_bands(const Spectrum& spectrum, const WavelengthGrid& bands) {
    Eigen::VectorXd values(bands.count);
    for (int k = 0; k < bands.count; ++k)
        values(k) = spectrum(bands.centre_nm(k));
    return values;
}

/// The dyes as a fit knows them: an emission of one number a band.
inline DyeValues values_of_dyes(const std::vector<SlabDye>& dyes, const WavelengthGrid& bands) {
    DyeValues values;
    const auto count = static_cast<Eigen::Index>(dyes.size());
    values.depth.resize(bands.count, count);
    values.quantum_yield.resize(count);
    for (Eigen::Index d = 0; d < count; ++d) {
        const SlabDye& dye = dyes[static_cast<std::size_t>(d)];
        values.depth.col(d) = dye.concentration * on_bands(dye.absorption, bands);
        values.quantum_yield(d) = dye.quantum_yield;
        Eigen::VectorXd emission(bands.count);
        for (int k = 0; k < bands.count; ++k)
            emission(k) = dye.emission.average(bands.lower_edge_nm(k), bands.upper_edge_nm(k));
        values.shares.emplace_back(emission / emission.sum(), bands);
    }
    return values;
}

} // namespace reradiant
