#include "host/fit/solver/bounded_quadratic.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include <cmath>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Indices = std::vector<Eigen::Index>;

Indices indices_of(const std::vector<bool>& free) {
    Indices indices;
    for (std::size_t k = 0; k < free.size(); ++k)
        if (free[k])
            indices.push_back(static_cast<Eigen::Index>(k));
    return indices;
}

/// Rows and columns of a symmetric matrix; of a full one the lower triangle is enough.
Matrix principal(const Matrix& h, const Indices& indices) {
    const auto n = static_cast<Eigen::Index>(indices.size());
    Matrix result(n, n);
    for (Eigen::Index column = 0; column < n; ++column)
        for (Eigen::Index row = column; row < n; ++row)
            result(row, column) = h(indices[static_cast<std::size_t>(row)],
                                    indices[static_cast<std::size_t>(column)]);
    return result;
}

Sparse principal(const Sparse& h, const Indices& indices) {
    std::vector<Eigen::Index> place(static_cast<std::size_t>(h.cols()), -1);
    for (std::size_t k = 0; k < indices.size(); ++k)
        place[static_cast<std::size_t>(indices[k])] = static_cast<Eigen::Index>(k);
    std::vector<Eigen::Triplet<double>> entries;
    for (const Eigen::Index column : indices)
        for (Sparse::InnerIterator it(h, column); it; ++it)
            if (const Eigen::Index row = place[static_cast<std::size_t>(it.row())]; row >= 0)
                entries.emplace_back(static_cast<int>(row),
                                     static_cast<int>(place[static_cast<std::size_t>(column)]),
                                     it.value());
    const auto n = static_cast<Eigen::Index>(indices.size());
    Sparse result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

template <typename Factorisation>
std::optional<Vector> solution(const Factorisation& factors, const Vector& right) {
    if (factors.info() != Eigen::Success)
        return std::nullopt;
    const Vector result = factors.solve(right);
    return result.allFinite() ? std::optional(result) : std::nullopt;
}

std::optional<Vector> solve_positive(Matrix h, const Vector& right) {
    return solution(Eigen::LLT<Eigen::Ref<Matrix>>(h), right);
}

std::optional<Vector> solve_positive(const Sparse& h, const Vector& right) {
    return solution(Eigen::SimplicialLLT<Sparse>(h), right);
}

/// Minimiser over the free parameters, 0 elsewhere.
template <typename Hessian>
std::optional<Vector> free_minimiser(const Quadratic<Hessian>& quadratic, const Indices& indices) {
    Vector y = Vector::Zero(quadratic.c.size());
    if (indices.empty())
        return y;
    Vector right(static_cast<Eigen::Index>(indices.size()));
    for (std::size_t k = 0; k < indices.size(); ++k)
        right(static_cast<Eigen::Index>(k)) = -quadratic.c(indices[k]);
    const auto solved = solve_positive(principal(quadratic.h, indices), right);
    if (!solved)
        return std::nullopt;
    for (std::size_t k = 0; k < indices.size(); ++k)
        y(indices[k]) = (*solved)(static_cast<Eigen::Index>(k));
    return y;
}

/// Parameters of the wrong sign: free ones below zero, held ones that the slope pulls upwards.
Indices infeasible(const Vector& y, const Vector& slope, const std::vector<bool>& bounded,
                   const std::vector<bool>& free) {
    Indices wrong;
    for (std::size_t k = 0; k < free.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        if (bounded[k] && (free[k] ? y(i) < 0.0 : slope(i) < 0.0))
            wrong.push_back(i);
    }
    return wrong;
}

} // namespace

template <typename Hessian>
std::optional<Vector> minimise_quadratic(const Quadratic<Hessian>& quadratic,
                                         const std::vector<bool>& bounded,
                                         std::vector<bool>& free) {
    constexpr int most_rounds = 12;
    std::size_t least = free.size() + 1;
    int patience = 3; // full exchanges that may pass without progress
    for (int round = 0; round < most_rounds; ++round) {
        const auto y = free_minimiser(quadratic, indices_of(free));
        if (!y)
            return std::nullopt;
        const Vector slope = quadratic.h * *y + quadratic.c;
        const Indices wrong = infeasible(*y, slope, bounded, free);
        if (wrong.empty())
            return y;
        if (wrong.size() < least) {
            least = wrong.size();
            patience = 3;
        } else {
            --patience;
        }
        const std::size_t first = patience >= 0 ? 0 : wrong.size() - 1;
        for (std::size_t k = first; k < wrong.size(); ++k) {
            const auto i = static_cast<std::size_t>(wrong[k]);
            free[i] = !free[i];
        }
    }
    return std::nullopt;
}

template std::optional<Vector> minimise_quadratic(const Quadratic<Matrix>&,
                                                  const std::vector<bool>&, std::vector<bool>&);
template std::optional<Vector> minimise_quadratic(const Quadratic<Sparse>&,
                                                  const std::vector<bool>&, std::vector<bool>&);

} // namespace reradiant
