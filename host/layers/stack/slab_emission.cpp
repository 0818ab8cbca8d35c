#include "host/layers/stack/slab_emission.h"

#include "reradiant/reradiation.h"

namespace reradiant {

namespace {

Eigen::MatrixXd given_shares(const ReradiationMatrix& shares, const WavelengthGrid& bands) {
    if (shares.emission == bands && shares.excitation == bands)
        return shares.values;
    Eigen::MatrixXd values = fluorescence_on_cells(shares, bands);
    const Spectrum within = shares.reflectance();
    for (int band = 0; band < bands.count; ++band)
        values(band, band) += within(bands.centre_nm(band));
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
