#include "host/fit/dye/dye_start.h"

#include "host/fit/factors/factor_start.h"

#include <chrono>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Optical depths at the peak that are tried.
constexpr double tried_depths[] = {0.1, 0.5, 2.0, 6.0};
constexpr int steps_of_a_start = 8;
constexpr double first_yield = 0.5;
/// Largest start of a depth, of what the tables hold.
constexpr double within_tables = 0.7;
/// Least part of a spectrum's peak everywhere: at zero a band may seem to do nothing.
constexpr double floor_of_peak = 1e-3;

/// The entries of the first block above the excitation.
FitTarget first_target(const DyeProblem& problem) {
    const DyeDataSet& set = *problem.samples.front().data;
    FitTarget target;
    target.emission = set.data.emission;
    target.excitation = set.data.excitation;
    target.allowed = allowed_entries(target.emission, target.excitation, false);
    target.value = set.blocks.front().value.cwiseProduct(target.allowed);
    target.weight = set.blocks.front().weight.cwiseProduct(target.allowed);
    return target;
}

/// Takes away from curves what hardly any light shows: at waves that are absorbed only above nearly
/// all emission, a factorisation may say anything.
void damp_unseen(const FitTarget& target, FactorCurves& curves) {
    constexpr double hardly = 0.01; // of the energy that the best seen band shows
    const Matrix squared = target.weight.cwiseAbs2();
    const auto damp = [&](Matrix& curve, const Matrix& seen) {
        for (Index k = 0; k < curve.cols(); ++k)
            curve.col(k).array() *=
                seen.col(k).array() /
                (seen.col(k).array() + hardly * seen.col(k).maxCoeff() + 1e-300);
    };
    damp(curves.excitation, squared.transpose() * curves.emission.cwiseAbs2());
    damp(curves.emission, squared * curves.excitation.cwiseAbs2());
    damp(curves.excitation, squared.transpose() * curves.emission.cwiseAbs2());
}

Matrix with_floor(const Matrix& curves) {
    Matrix floored = curves;
    for (Index k = 0; k < curves.cols(); ++k)
        floored.col(k) =
            curves.col(k).cwiseMax(floor_of_peak * std::max(curves.col(k).maxCoeff(), 1e-12));
    return floored;
}

/// Parameters whose excitation spectra are those of a slab of some depth at their peaks, twice
/// passed.
DyeParameters at_depth(const DyeProblem& problem, const FactorCurves& curves, double depth) {
    const Index dyes = curves.emission.cols(), bands = problem.bands.count;
    DyeParameters start;
    start.absorption = Matrix::Zero(bands, dyes);
    start.emission = Matrix::Zero(bands, dyes);
    for (Index k = 0; k < dyes; ++k) {
        const Vector seen = curves.excitation.col(k).cwiseQuotient(problem.lamp);
        const Vector share =
            (1.0 - std::exp(-2.0 * depth)) / std::max(seen.maxCoeff(), 1e-300) * seen;
        start.absorption.col(k).segment(problem.excitation.first, problem.excitation.count) =
            -0.5 * (-share.array()).log1p() / problem.samples.front().depth_factor;
        start.emission.col(k).segment(problem.emission.first, problem.emission.count) =
            curves.emission.col(k);
    }
    start.absorption = with_floor(start.absorption);
    const double most = start.absorption.rowwise().sum().maxCoeff();
    if (most > within_tables * problem.largest_absorption())
        start.absorption *= within_tables * problem.largest_absorption() / most;
    start.emission.middleRows(problem.emission.first, problem.emission.count) =
        with_floor(start.emission.middleRows(problem.emission.first, problem.emission.count));
    start.emission.array().rowwise() /= start.emission.colwise().sum().array();
    start.quantum_yield = Vector::Constant(dyes, first_yield);
    start.scale = first_yield;
    if (problem.fits_substrate)
        start.reflectance = Vector::Constant(bands, 0.5);
    return start;
}

/// Yields, or the scale, by which the light is about right.
void set_brightness(const DyeModel& model, DyeParameters& start) {
    double product = 0.0, square = 0.0;
    const auto images = model.images(model.packed(start));
    for (std::size_t s = 0; s < images.size(); ++s) {
        const DyeDataSet& set = *model.problem().samples[s].data;
        const Matrix above = allowed_entries(set.data.emission, set.data.excitation, false);
        for (std::size_t view = 0; view < images[s].size(); ++view) {
            const DyeBlock& block = set.blocks[view];
            const Matrix seen = images[s][view].cwiseProduct(block.weight).cwiseProduct(above);
            product += seen.cwiseProduct(block.value.cwiseProduct(block.weight)).sum();
            square += seen.squaredNorm();
        }
    }
    const double factor = square > 0.0 ? std::max(product / square, 1e-6) : 1.0;
    if (model.problem().fits_scale)
        start.scale *= factor;
    else
        start.quantum_yield = (factor * start.quantum_yield).cwiseMax(0.02).cwiseMin(0.95);
}

} // namespace

DyeParameters dye_start(const DyeProblem& problem, int dyes, const SolverSettings& settings) {
    const auto begin = std::chrono::steady_clock::now();
    const FitTarget target = first_target(problem);
    FactorCurves curves = factor_starts(target, dyes, {}, 1, 0, 1).front();
    damp_unseen(target, curves);
    const DyeModel model(problem, per_band_basis(problem.bands),
                         per_band_basis(problem.samples.front().data->data.emission), dyes);
    SolverSettings few = settings;
    few.most_iterations = steps_of_a_start;
    double least = std::numeric_limits<double>::infinity();
    DyeParameters best;
    for (const double depth : tried_depths) {
        DyeParameters start = at_depth(problem, curves, depth);
        set_brightness(model, start);
        Vector packed = model.packed(start);
        const SolveTrace trace = minimise_non_negative(model, packed, few, begin);
        if (!trace.cost.empty() && trace.final_cost() < least) {
            least = trace.final_cost();
            best = model.parameters(packed);
        }
    }
    return best;
}

} // namespace reradiant
