#include "host/layers/stack/slab_emission.h"

#include "reradiant/reradiation.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Returns the share of a target cell that lies in a source cell.
double covered(const WavelengthGrid& target, int cell, const WavelengthGrid& source, int from) {
    const double overlap = std::min(target.upper_edge_nm(cell), source.upper_edge_nm(from)) -
                           std::max(target.lower_edge_nm(cell), source.lower_edge_nm(from));
    return std::max(0.0, overlap) / target.step_nm;
}

/// Returns the shares on other bands. What a band sends out within itself stays within the bands
/// that lie in it: interpolated between bands, it could add up to more than was absorbed with what
/// is sent out elsewhere.
Eigen::MatrixXd given_shares(const ReradiationMatrix& shares, const WavelengthGrid& bands) {
    if (shares.emission == bands && shares.excitation == bands)
        return shares.values;
    Eigen::MatrixXd values = fluorescence_on_cells(shares, bands);
    for (int from = 0; from < shares.excitation.count; ++from)
        if (const int row = diagonal_row(shares, from); row >= 0)
            for (int band = 0; band < bands.count; ++band)
                values(band, band) +=
                    covered(bands, band, shares.excitation, from) * shares.values(row, from);
    return values;
}

} // namespace

Eigen::MatrixXd dye_shares(const SlabDye& dye, const WavelengthGrid& bands) {
    if (dye.shares)
        return given_shares(*dye.shares, bands);
    const Fluorophore all_absorbed{Spectrum::constant(1.0), dye.emission, dye.quantum_yield};
    return matrix_from_fluorophores({all_absorbed}, Spectrum(), bands, bands).values;
}

Eigen::MatrixXd slab_emission(const Layer& layer, const WavelengthGrid& bands) {
    if (!layer.is_dyed())
        return {};
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(bands.count, bands.count);
    for (const SlabDye& dye : layer.dyes) {
        Eigen::MatrixXd sent = dye_shares(dye, bands);
        for (int band = 0; band < bands.count; ++band)
            sent.col(band) *=
                dye.concentration * dye.absorption(bands.centre_nm(band)) * layer.thickness;
        sum += sent;
    }
    return sum;
}

std::vector<Eigen::MatrixXd> slab_emissions(const LayerStack& stack, const WavelengthGrid& bands) {
    std::vector<Eigen::MatrixXd> emissions;
    for (const Layer& layer : stack.layers)
        emissions.push_back(slab_emission(layer, bands));
    return emissions;
}

} // namespace reradiant
