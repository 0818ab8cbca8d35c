#include "host/render/tables/substrate_operator.h"

#include "host/layers/models/effective_matrix.h"
#include "host/layers/stack/slab_emission.h"
#include "host/scene/model/substrate.h"
#include "host/spectral/matrix/singular_values.h"
#include "reradiant/reradiation.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr int most_factors = 4; ///< most terms of a factorisation that is looked for
/// Most fluorophores that are applied by their factors, which are known: beyond that the dense
/// product costs no more.
constexpr std::size_t most_fluorophores = 8;
/// Factors are applied in single precision.
constexpr double largest_factor = 1e12;
/// Above this relative error a matrix is applied densely, so that nothing is dropped: it is the
/// size of single-precision rounding over a path.
constexpr double factor_tolerance = 1e-6;

bool has_upper_triangle(const Eigen::MatrixXd& matrix) {
    for (Eigen::Index i = 0; i < matrix.cols(); ++i)
        for (Eigen::Index o = 0; o < i; ++o)
            if (matrix(o, i) != 0.0)
                return true;
    return false;
}

/// Returns false when the strictly lower triangle cannot be a masked product of few terms at all.
/// In such a product every block of the rows from a split on and the columns before it has at most
/// that rank. One singular value more than that above the tolerance, at one of three splits, says
/// no, in milliseconds instead of a long search.
bool may_factor(const Eigen::MatrixXd& matrix) {
    const Eigen::Index n = matrix.rows();
    const double bound = 10.0 * factor_tolerance * matrix.norm();
    for (const Eigen::Index split : {n / 4, n / 2, 3 * n / 4}) {
        const Eigen::MatrixXd block = matrix.bottomLeftCorner(n - split, split);
        if (std::min(block.rows(), block.cols()) <= most_factors)
            continue;
        if (singular_values(block)(most_factors) > bound)
            return false;
    }
    return true;
}

/// Factors within the tolerance, or none.
MaskedFactors find_factors(const Substrate& substrate, const WavelengthGrid& cells,
                           const Eigen::MatrixXd& fluorescence) {
    if (!substrate.matrix && substrate.fluorophores.size() <= most_fluorophores) {
        MaskedFactors known = factors_of_fluorophores(substrate.fluorophores, cells);
        return known.excitation.maxCoeff() <= largest_factor ? known : MaskedFactors{};
    }
    if (!may_factor(fluorescence))
        return {};
    MaskedFactors found = factorise_lower(fluorescence, most_factors, factor_tolerance);
    return found.relative_error <= factor_tolerance ? found : MaskedFactors{};
}

/// 1, or 1 / step for a line, whose radiance is integrated over wavelength.
double excitation_unit(const WavelengthPlan& plan, const Lane& lane) {
    return lane.is_line ? 1.0 / plan.comb.step_nm : 1.0;
}

Eigen::VectorXd lane_reflectance(const Substrate& substrate, const SubstrateOnCells& on_cells,
                                 const WavelengthPlan& plan, int phase) {
    Eigen::VectorXd diagonal(static_cast<Eigen::Index>(plan.lanes.size()));
    for (int lane = 0; lane < static_cast<int>(plan.lanes.size()); ++lane) {
        diagonal(lane) = substrate.reflectance(plan.wavelength_nm(lane, phase));
        const int cell = plan.lanes[static_cast<std::size_t>(lane)].cell;
        if (on_cells.fluorescence.size() > 0)
            diagonal(lane) += on_cells.fluorescence(cell, cell);
    }
    return diagonal;
}

/// Factors from cells to lanes. A line only excites: it has no width to emit into.
SemiseparableMatrix factored_on_lanes(const SubstrateOnCells& on_cells, const WavelengthPlan& plan,
                                      const Eigen::VectorXd& diagonal) {
    const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
    SemiseparableMatrix matrix{diagonal, Eigen::MatrixXd::Zero(lanes, on_cells.emission.cols()),
                               Eigen::MatrixXd::Zero(lanes, on_cells.emission.cols())};
    for (Eigen::Index l = 0; l < lanes; ++l) {
        const Lane& lane = plan.lanes[static_cast<std::size_t>(l)];
        if (!lane.is_line)
            matrix.emission.row(l) = on_cells.emission.row(lane.cell);
        matrix.excitation.row(l) = on_cells.excitation.row(lane.cell) * excitation_unit(plan, lane);
    }
    return matrix;
}

} // namespace

Eigen::MatrixXd cells_on_lanes(const Eigen::MatrixXd& cells, const WavelengthPlan& plan) {
    const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(lanes, lanes);
    for (Eigen::Index i = 0; i < lanes; ++i) {
        const Lane& from = plan.lanes[static_cast<std::size_t>(i)];
        matrix(i, i) = cells(from.cell, from.cell);
        for (Eigen::Index o = 0; o < lanes; ++o) {
            const Lane& to = plan.lanes[static_cast<std::size_t>(o)];
            if (!to.is_line && to.cell != from.cell)
                matrix(o, i) = cells(to.cell, from.cell) * excitation_unit(plan, from);
        }
    }
    return matrix;
}

std::vector<Eigen::MatrixXd> dyes_on_lanes(const Layer& layer, const WavelengthPlan& plan) {
    std::vector<Eigen::MatrixXd> by_phase(static_cast<std::size_t>(plan.phases));
    if (!layer.is_dyed())
        return by_phase;
    const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
    for (Eigen::MatrixXd& sum : by_phase)
        sum.setZero(lanes, lanes);
    for (const SlabDye& dye : layer.dyes) {
        const Eigen::MatrixXd shares = cells_on_lanes(dye_shares(dye, plan.comb), plan);
        for (int phase = 0; phase < plan.phases; ++phase)
            for (int lane = 0; lane < static_cast<int>(lanes); ++lane)
                by_phase[static_cast<std::size_t>(phase)].col(lane) +=
                    shares.col(lane) * (dye.concentration * layer.thickness *
                                        dye.absorption(plan.wavelength_nm(lane, phase)));
    }
    return by_phase;
}

Eigen::MatrixXd substrate_on_lanes(const Substrate& substrate, const SubstrateOnCells& on_cells,
                                   const WavelengthPlan& plan, int phase) {
    const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(lanes, lanes);
    if (on_cells.fluorescence.size() > 0)
        matrix = cells_on_lanes(on_cells.fluorescence, plan);
    matrix.diagonal() = lane_reflectance(substrate, on_cells, plan, phase);
    return matrix;
}

Eigen::VectorXd LaneOperator::row_sums() const {
    Eigen::VectorXd sums = diagonal;
    if (dense.size() > 0)
        return sums + dense.rowwise().sum();
    Eigen::VectorXd before = Eigen::VectorXd::Zero(emission.cols());
    for (Eigen::Index lane = 0; lane < diagonal.size() && emission.cols() > 0; ++lane) {
        sums(lane) += emission.row(lane).dot(before);
        before += excitation.row(lane).transpose();
    }
    return sums;
}

SubstrateOnCells substrate_on_cells(const Substrate& substrate, const WavelengthGrid& cells) {
    SubstrateOnCells on_cells;
    if (!substrate.is_fluorescent())
        return on_cells;
    on_cells.fluorescence = fluorescence_of(substrate, cells);
    if (has_upper_triangle(on_cells.fluorescence))
        return on_cells; // anti-Stokes emission: the masked form cannot hold it
    const MaskedFactors factors = find_factors(substrate, cells, on_cells.fluorescence);
    on_cells.emission = factors.emission;
    on_cells.excitation = factors.excitation;
    return on_cells;
}

LaneOperator lane_operator(const Substrate& substrate, const SubstrateOnCells& on_cells,
                           const WavelengthPlan& plan, int phase, double albedo,
                           const Eigen::VectorXd& r, const Eigen::VectorXd& scale) {
    const Eigen::VectorXd diagonal = albedo * lane_reflectance(substrate, on_cells, plan, phase);
    LaneOperator result;
    if (on_cells.fluorescence.size() == 0) {
        result.diagonal = scale.array() * diagonal.array() / (1.0 - r.array() * diagonal.array());
        return result;
    }
    if (on_cells.is_factored()) {
        SemiseparableMatrix matrix = factored_on_lanes(on_cells, plan, diagonal);
        matrix.emission *= albedo;
        const SemiseparableMatrix effective = effective_semiseparable(matrix, r);
        result.diagonal = scale.cwiseProduct(effective.diagonal);
        result.emission = scale.asDiagonal() * effective.emission;
        result.excitation = effective.excitation;
        return result;
    }
    // Under a line a column is in 1/nm; the solve works on irradiance alike.
    const Eigen::MatrixXd matrix = albedo * substrate_on_lanes(substrate, on_cells, plan, phase);
    result.dense = scale.asDiagonal() * effective_matrix(matrix, r);
    result.diagonal = result.dense.diagonal();
    result.dense.diagonal().setZero();
    return result;
}

} // namespace reradiant
