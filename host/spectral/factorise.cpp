#include "host/spectral/masked_least_squares.h"
#include "host/spectral/reradiation.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int random_starts = 4;
constexpr int polished_starts = 3;
constexpr int sweeps_per_start = 60;

struct Candidate {
    Matrix emission, excitation;
    double cost = 0.0;
};

/// Uniform in [0, 1), the same on every machine (splitmix64; Steele, Lea and Flood 2014).
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
Candidate singular_start(const Matrix& target, int rank) {
    const Eigen::BDCSVD<Matrix> svd(target, Eigen::ComputeThinU | Eigen::ComputeThinV);
    Candidate start{Matrix::Zero(target.rows(), rank), Matrix::Zero(target.cols(), rank)};
    for (int k = 0; k < rank && k < svd.singularValues().size(); ++k) {
        const Vector u = svd.matrixU().col(k), v = svd.matrixV().col(k);
        const Vector up = u.cwiseMax(0.0), vp = v.cwiseMax(0.0);
        const Vector um = (-u).cwiseMax(0.0), vm = (-v).cwiseMax(0.0);
        const bool plus = up.norm() * vp.norm() >= um.norm() * vm.norm();
        const double scale = std::sqrt(svd.singularValues()(k));
        start.emission.col(k) = scale * (plus ? up : um);
        start.excitation.col(k) = scale * (plus ? vp : vm);
    }
    // Zeros are traps for alternating updates.
    start.emission.array() += 1e-3 * start.emission.mean() + 1e-12;
    start.excitation.array() += 1e-3 * start.excitation.mean() + 1e-12;
    return start;
}

/// The best of the rank below plus one term from what it leaves over.
Candidate grown_start(const MaskedLeastSquares& problem, const Candidate& smaller) {
    const Eigen::Index rank = smaller.emission.cols() + 1, n = problem.target.rows();
    const Matrix rest = (-problem.residual(smaller.emission, smaller.excitation)).cwiseMax(0.0);
    Candidate term = singular_start(rest, 1);
    Candidate start{Matrix(n, rank), Matrix(n, rank)};
    start.emission << smaller.emission, term.emission;
    start.excitation << smaller.excitation, term.excitation;
    return start;
}

Candidate random_start(const Matrix& target, int rank, std::uint64_t seed) {
    FixedRandom random(seed);
    const double size = std::sqrt(target.cwiseAbs().mean() * 4.0 / rank) + 1e-6;
    Candidate start{Matrix(target.rows(), rank), Matrix(target.cols(), rank)};
    start.emission = start.emission.unaryExpr([&](double) { return size * random(); });
    start.excitation = start.excitation.unaryExpr([&](double) { return size * random(); });
    return start;
}

/// Steps of the second-order method that a size can afford: each costs about n^3 K^3 operations.
int affordable_steps(Eigen::Index bands, int rank) {
    const double operations = std::pow(static_cast<double>(bands * rank), 3.0);
    return static_cast<int>(std::clamp(2e9 / operations, 2.0, 150.0));
}

Candidate best_of_rank(const MaskedLeastSquares& problem, int rank, const Candidate& smaller) {
    std::vector<Candidate> starts = {singular_start(problem.target, rank),
                                     grown_start(problem, smaller)};
    for (int k = 0; rank > 1 && k < random_starts; ++k)
        starts.push_back(random_start(problem.target, rank, static_cast<std::uint64_t>(k) + 1));
    for (Candidate& start : starts) {
        problem.descend(start.emission, start.excitation, sweeps_per_start);
        start.cost = problem.cost(start.emission, start.excitation);
    }
    const auto cheaper = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    std::sort(starts.begin(), starts.end(), cheaper);
    starts.resize(std::min<std::size_t>(starts.size(), polished_starts));
    const int steps = affordable_steps(problem.target.rows(), rank);
    for (Candidate& start : starts) {
        problem.polish(start.emission, start.excitation, steps);
        start.cost = problem.cost(start.emission, start.excitation);
    }
    return *std::min_element(starts.begin(), starts.end(), cheaper);
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
    Candidate best{result.emission, result.excitation};
    result.relative_error = 1.0;
    for (int rank = 1; rank <= max_rank && result.relative_error > tolerance; ++rank) {
        best = best_of_rank(problem, rank, best);
        result.relative_error = std::sqrt(best.cost) / whole;
    }
    result.emission = best.emission * scale;
    result.excitation = best.excitation;
    return result;
}

} // namespace reradiant
