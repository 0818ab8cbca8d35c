#include "host/spectral/matrix/masked_least_squares.h"
#include "host/spectral/matrix/singular_values.h"
#include "reradiant/reradiation.h"

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double exactly = 1e-8; ///< relative error at which no other start is tried
constexpr int random_starts = 3;

/// Starts race: all for a few steps, the better ones further.
struct Round {
    int sweeps, approach_steps;
    std::size_t kept;
};
constexpr std::array rounds = {Round{40, 10, 4}, Round{10, 25, 2}, Round{10, 60, 2},
                               Round{10, 100, 1}};

struct Candidate {
    FactorPair factors;
    double cost = 0.0;
};

/// `FixedRandom` draws numbers uniform in [0, 1), the same on every machine (splitmix64; Steele,
/// Lea and Flood 2014).
class FixedRandom {
public:
    explicit FixedRandom(std::uint64_t seed) : state_(seed) {}
    double operator()() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
    }

private:
    std::uint64_t state_;
};

/// Non-negative double SVD (Boutsidis and Gallopoulos 2008): of each singular pair the sign that
/// carries more energy.
FactorPair singular_start(const Matrix& target, int rank) {
    const ThinSvd svd = thin_svd(target);
    FactorPair start{Matrix::Zero(target.rows(), rank), Matrix::Zero(target.cols(), rank)};
    for (int k = 0; k < rank && k < svd.s.size(); ++k) {
        const Vector u = svd.u.col(k), v = svd.v.col(k);
        const Vector up = u.cwiseMax(0.0), vp = v.cwiseMax(0.0);
        const Vector um = (-u).cwiseMax(0.0), vm = (-v).cwiseMax(0.0);
        const bool plus = up.norm() * vp.norm() >= um.norm() * vm.norm();
        const double scale = std::sqrt(svd.s(k));
        start.emission.col(k) = scale * (plus ? up : um);
        start.excitation.col(k) = scale * (plus ? vp : vm);
    }
    // Zeros are traps for alternating updates.
    start.emission.array() += 1e-3 * start.emission.mean() + 1e-12;
    start.excitation.array() += 1e-3 * start.excitation.mean() + 1e-12;
    return start;
}

/// The best of the rank below plus one term from what it leaves over.
FactorPair grown_start(const MaskedLeastSquares& problem, const FactorPair& smaller) {
    const Eigen::Index rank = smaller.emission.cols() + 1, n = problem.target.rows();
    const FactorPair term = singular_start((-problem.residual(smaller)).cwiseMax(0.0), 1);
    FactorPair start{Matrix(n, rank), Matrix(n, rank)};
    start.emission << smaller.emission, term.emission;
    start.excitation << smaller.excitation, term.excitation;
    return start;
}

/// Columns that are least mixtures of others (successive projection; Araujo et al. 2001), as the
/// spectra of single fluorophores where one alone absorbs; faint columns count as much as strong.
Matrix extreme_columns(const Matrix& known, int rank) {
    constexpr double faintest = 1e-5;
    Matrix rest = known;
    const double strongest = known.colwise().norm().maxCoeff();
    for (Eigen::Index i = 0; i < rest.cols(); ++i)
        rest.col(i) *= known.col(i).norm() > faintest * strongest ? 1.0 / known.col(i).norm() : 0.0;
    Matrix columns = Matrix::Zero(known.rows(), rank);
    for (int k = 0; k < rank; ++k) {
        Eigen::Index at = 0;
        if (!(rest.colwise().norm().maxCoeff(&at) > 0.0))
            break;
        columns.col(k) = known.col(at) / known.col(at).norm();
        const Vector direction = rest.col(at).normalized();
        rest -= direction * (direction.transpose() * rest);
    }
    return columns;
}

/// Factors of the rectangle below the diagonal where most is known, from its extreme columns
/// (`of_columns`) or rows, and by least squares for the other side.
FactorPair extreme_start(const Matrix& target, int rank, bool of_columns) {
    const Eigen::Index n = target.rows(), split = n / 2, rows = n - split;
    const Matrix known = target.bottomLeftCorner(rows, split);
    const Matrix basis = extreme_columns(of_columns ? known : Matrix(known.transpose()), rank);
    const Matrix other = Eigen::CompleteOrthogonalDecomposition<Matrix>(basis)
                             .solve(of_columns ? known : Matrix(known.transpose()))
                             .transpose()
                             .cwiseMax(0.0);
    const double floor = 1e-6;
    FactorPair start{Matrix::Constant(n, rank, floor), Matrix::Constant(n, rank, floor)};
    start.emission.bottomRows(rows) += of_columns ? basis : other;
    start.excitation.topRows(split) += of_columns ? other : basis;
    return start;
}

FactorPair random_start(const Matrix& target, int rank, std::uint64_t seed) {
    FixedRandom random(seed);
    const double size = std::sqrt(target.cwiseAbs().mean() * 4.0 / rank) + 1e-6;
    FactorPair start{Matrix(target.rows(), rank), Matrix(target.cols(), rank)};
    for (Matrix* factor : {&start.emission, &start.excitation})
        for (double& entry : factor->reshaped())
            entry = size * random();
    return start;
}

/// For each rank a relative error that no factors can beat, non-negative or not: every rectangle
/// below the diagonal is wholly known, and its truncated SVD is its best approximation.
std::vector<double> unbeatable_errors(const Matrix& target, int max_rank) {
    const Eigen::Index n = target.rows(), stride = std::max<Eigen::Index>(1, n / 12);
    std::vector<double> bounds(static_cast<std::size_t>(max_rank) + 1, 0.0);
    for (Eigen::Index split = 1; split < n; split += stride) {
        const Matrix known = target.bottomLeftCorner(n - split, split);
        const Vector values = singular_values(known);
        for (Eigen::Index rank = 0; rank <= max_rank && rank < values.size(); ++rank) {
            double& bound = bounds[static_cast<std::size_t>(rank)];
            bound = std::max(bound, values.tail(values.size() - rank).norm() / target.norm());
        }
    }
    return bounds;
}

/// Steps of the second-order method that a size can afford: each costs about n^3 K^3 operations.
/// None at several hundred bands, where one would take seconds and descent must do.
int affordable_steps(Eigen::Index bands, int rank) {
    const double operations = std::pow(static_cast<double>(bands * rank), 3.0);
    const double budget = operations < 2e7 ? 2e9 : 4e8;
    return static_cast<int>(std::min(budget / operations, 100.0));
}

void improve(const MaskedLeastSquares& problem, const Round& round, Candidate& candidate) {
    const int steps = affordable_steps(problem.target.rows(),
                                       static_cast<int>(candidate.factors.emission.cols()));
    FactorPair trial = candidate.factors;
    problem.descend(trial, round.sweeps);
    const FactorPair descended = trial;
    problem.approach(trial, std::min(steps, round.approach_steps));
    // The entries that are set to zero at the end of an approach may cost more than it gained.
    if (problem.cost(trial) > problem.cost(descended))
        trial = descended;
    candidate = {trial, problem.cost(trial)};
}

/// Runs the race of many starts; ends it when one is good enough.
Candidate best_of_rank(const MaskedLeastSquares& problem, int rank, const FactorPair& smaller,
                       double good_enough) {
    const auto cheaper = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    std::vector<Candidate> candidates = {{singular_start(problem.target, rank)},
                                         {grown_start(problem, smaller)}};
    for (const bool of_columns : {true, false})
        if (rank > 1 && problem.target.rows() > 2)
            candidates.push_back({extreme_start(problem.target, rank, of_columns)});
    for (int k = 0; rank > 1 && k < random_starts; ++k)
        candidates.push_back(
            {random_start(problem.target, rank, static_cast<std::uint64_t>(k) + 1)});
    for (const Round& round : rounds) {
        for (Candidate& candidate : candidates) {
            improve(problem, round, candidate);
            if (candidate.cost <= good_enough)
                return candidate;
        }
        std::sort(candidates.begin(), candidates.end(), cheaper);
        candidates.resize(std::min(candidates.size(), round.kept));
    }
    Candidate& best = candidates.front();
    problem.polish(best.factors, affordable_steps(problem.target.rows(), rank) / 4);
    best.cost = problem.cost(best.factors);
    return best;
}

/// A rank that cannot be the answer: one start, only as the seed of the next rank.
Candidate passing_rank(const MaskedLeastSquares& problem, const FactorPair& smaller) {
    Candidate candidate{grown_start(problem, smaller)};
    improve(problem, rounds.front(), candidate);
    return candidate;
}

} // namespace

MaskedFactors factorise_lower(const Matrix& square, int max_rank, double tolerance) {
    if (square.rows() != square.cols())
        throw std::invalid_argument("only a square matrix has a lower triangle to factorise");
    MaskedLeastSquares problem{square.triangularView<Eigen::StrictlyLower>()};
    MaskedFactors result{Matrix(square.rows(), 0), Matrix(square.rows(), 0), 0.0};
    if (!problem.target.allFinite())
        throw std::invalid_argument("a matrix with values that are not finite has no factors");
    const double scale = square.rows() > 0 ? problem.target.cwiseAbs().maxCoeff() : 0.0;
    if (!(scale > 0.0))
        return result;
    problem.target /= scale;
    const double whole = problem.target.norm();
    const double good_enough = std::pow(exactly * whole, 2);
    Candidate best{{result.emission, result.excitation}};
    result.relative_error = 1.0;
    const std::vector<double> bounds = unbeatable_errors(problem.target, std::max(0, max_rank));
    for (int rank = 1; rank <= max_rank && result.relative_error > tolerance; ++rank) {
        const bool hopeless = bounds[static_cast<std::size_t>(rank)] > tolerance;
        best = hopeless && rank < max_rank ? passing_rank(problem, best.factors)
                                           : best_of_rank(problem, rank, best.factors, good_enough);
        result.relative_error = std::sqrt(best.cost) / whole;
    }
    result.emission = best.factors.emission * scale;
    result.excitation = best.factors.excitation;
    return result;
}

} // namespace reradiant
