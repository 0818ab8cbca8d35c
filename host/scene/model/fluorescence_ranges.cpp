#include "host/scene/model/fluorescence_ranges.h"

#include "reradiant/reradiation.h"

#include <Eigen/Core>

#include <algorithm>

namespace reradiant {

namespace {

/// Wavelengths looked at where a spectrum itself has no end (constants, tables outside their
/// data): beyond them no source, detector or dye of this field works.
constexpr int SEARCH_FROM_NM = 200, SEARCH_TO_NM = 1200;

void widen(std::array<double, 2>& range, double from_nm, double to_nm) {
    const bool empty = range[1] <= range[0];
    range = {empty ? from_nm : std::min(range[0], from_nm),
             empty ? to_nm : std::max(range[1], to_nm)};
}

/// Returns the bands of the matrix's grids whose columns and rows of `values` are not zero.
FluorescenceRanges ranges_of_values(const ReradiationMatrix& matrix,
                                    const Eigen::MatrixXd& values) {
    FluorescenceRanges ranges;
    for (int i = 0; i < matrix.excitation.count; ++i)
        if (values.col(i).maxCoeff() > 0.0)
            widen(ranges.excitation, matrix.excitation.lower_edge_nm(i),
                  matrix.excitation.upper_edge_nm(i));
    for (int o = 0; o < matrix.emission.count; ++o)
        if (values.row(o).maxCoeff() > 0.0)
            widen(ranges.emission, matrix.emission.lower_edge_nm(o),
                  matrix.emission.upper_edge_nm(o));
    return ranges;
}

/// A fluorophore emits only above the wavelength that it absorbs.
FluorescenceRanges ranges_of_fluorophore(const Fluorophore& fluorophore) {
    const auto excitation = support_nm(fluorophore.excitation);
    const auto emission = support_nm(fluorophore.emission);
    if (fluorophore.quantum_yield <= 0.0 || excitation[1] <= 0.0 || excitation[0] >= emission[1])
        return {};
    return {{excitation[0], std::min(excitation[1], emission[1])},
            {std::max(emission[0], excitation[0]), emission[1]}};
}

/// Shares count in the bands that are absorbed, what is sent out within its own band too.
FluorescenceRanges ranges_of_shares(const ReradiationMatrix& shares, const Spectrum& absorption) {
    Eigen::MatrixXd values = shares.values;
    for (int i = 0; i < shares.excitation.count; ++i)
        if (absorption.is_zero_within(shares.excitation.lower_edge_nm(i),
                                      shares.excitation.upper_edge_nm(i)))
            values.col(i).setZero();
    return ranges_of_values(shares, values);
}

} // namespace

void FluorescenceRanges::join(const FluorescenceRanges& other) {
    if (other.is_empty())
        return;
    widen(excitation, other.excitation[0], other.excitation[1]);
    widen(emission, other.emission[0], other.emission[1]);
}

std::array<double, 2> support_nm(const Spectrum& spectrum) {
    const auto lit = [&](int nm) { return !spectrum.is_zero_within(nm, nm + 1.0); };
    int from = SEARCH_FROM_NM;
    while (from < SEARCH_TO_NM && !lit(from))
        ++from;
    if (from == SEARCH_TO_NM)
        return {0.0, 0.0};
    int to = SEARCH_TO_NM;
    while (!lit(to - 1))
        --to;
    return {static_cast<double>(from), static_cast<double>(to)};
}

FluorescenceRanges fluorescence_ranges(const Substrate& substrate) {
    if (substrate.matrix)
        return ranges_of_values(*substrate.matrix, substrate.matrix->fluorescent_part());
    FluorescenceRanges ranges;
    for (const Fluorophore& fluorophore : substrate.fluorophores)
        ranges.join(ranges_of_fluorophore(fluorophore));
    return ranges;
}

FluorescenceRanges fluorescence_ranges(const SlabDye& dye) {
    if (!dye.absorbs())
        return {};
    return dye.shares ? ranges_of_shares(*dye.shares, dye.absorption)
                      : ranges_of_fluorophore({dye.absorption, dye.emission, dye.quantum_yield});
}

FluorescenceRanges fluorescence_ranges(const LayerStack& stack) {
    FluorescenceRanges ranges;
    for (const Layer& layer : stack.layers)
        for (const SlabDye& dye : layer.dyes)
            if (layer.thickness > 0.0)
                ranges.join(fluorescence_ranges(dye));
    return ranges;
}

FluorescenceRanges fluorescence_ranges(const Material& material) {
    FluorescenceRanges ranges = fluorescence_ranges(material.substrate);
    ranges.join(fluorescence_ranges(material.stack));
    return ranges;
}

} // namespace reradiant
