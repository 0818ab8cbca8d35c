#include "host/layers/sources/fixed_point.h"

#include <Eigen/Jacobi>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace reradiant {

namespace {

/// Orthonormal directions, and the map's matrix in them made triangular by rotations.
class Subspace {
public:
    Subspace(const Eigen::VectorXd& first, Eigen::Index most)
        : basis_(first.size(), most + 1), triangle_(Eigen::MatrixXd::Zero(most + 1, most)),
          target_(Eigen::VectorXd::Zero(most + 1)) {
        target_(0) = first.norm();
        basis_.col(0) = first / target_(0);
    }

    Eigen::VectorXd last() const { return basis_.col(count_); }
    double residual() const { return std::fabs(target_(count_)); }

    /// Adds the image of the last direction.
    void add(Eigen::VectorXd image) {
        auto column = triangle_.col(count_);
        for (int pass = 0; pass < 2; ++pass) { // the second takes away what rounding left
            const Eigen::VectorXd along = basis_.leftCols(count_ + 1).transpose() * image;
            image -= basis_.leftCols(count_ + 1) * along;
            column.head(count_ + 1) += along;
        }
        const double rest = image.norm();
        column(count_ + 1) = rest;
        basis_.col(count_ + 1) = rest > 0.0 ? Eigen::VectorXd(image / rest) : image;
        for (Eigen::Index k = 0; k < count_; ++k)
            column.applyOnTheLeft(k, k + 1, rotations_[static_cast<std::size_t>(k)].adjoint());
        rotations_.emplace_back();
        rotations_.back().makeGivens(column(count_), column(count_ + 1));
        column.applyOnTheLeft(count_, count_ + 1, rotations_.back().adjoint());
        target_.applyOnTheLeft(count_, count_ + 1, rotations_.back().adjoint());
        ++count_;
    }

    Eigen::VectorXd solution() const {
        const Eigen::VectorXd along = triangle_.topLeftCorner(count_, count_)
                                          .triangularView<Eigen::Upper>()
                                          .solve(target_.head(count_));
        return basis_.leftCols(count_) * along;
    }

private:
    Eigen::Index count_ = 0;
    Eigen::MatrixXd basis_, triangle_;
    Eigen::VectorXd target_;
    std::vector<Eigen::JacobiRotation<double>> rotations_;
};

} // namespace

Eigen::VectorXd fixed_point(const Eigen::VectorXd& first,
                            const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map) {
    constexpr Eigen::Index most_directions = 400;
    constexpr double tolerance = 1e-13;
    const double norm = first.norm();
    if (!(norm > 0.0))
        return first;
    const Eigen::Index most = std::min(most_directions, first.size());
    Subspace space(first, most);
    for (Eigen::Index k = 0; k < most; ++k) {
        const Eigen::VectorXd direction = space.last();
        space.add(direction - map(direction));
        if (space.residual() <= tolerance * norm)
            return space.solution();
    }
    return Eigen::VectorXd::Constant(first.size(), std::numeric_limits<double>::quiet_NaN());
}

} // namespace reradiant
