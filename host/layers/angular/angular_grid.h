#pragma once

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Cells of direction on one side of a rough interface, over the cosine in that medium. The
/// flux of a uniform radiance through a cell is its etendue, n^2 (c_hi^2 - c_lo^2) (times pi).
struct AngularGrid {
    double ior = 1.0;
    double critical = 0.0;     ///< cosine below which the thinner medium reflects totally
    std::vector<double> edges; ///< ascending cosines, 0 ... 1

    int cells() const { return static_cast<int>(edges.size()) - 1; }
    int cell_of(double cosine) const;
    /// Etendue of every cell, positive.
    Eigen::VectorXd etendue() const;
    /// Edges as the invariant q = n^2 sin^2, descending.
    std::vector<double> invariants() const;
};

/// Grid on the thinner side (critical = 0) or on the denser side of an interface. Half of the
/// denser side's cells lie on each side of its critical cosine and crowd towards it, because
/// transmission starts there as a square root. They crowd towards the normal too: light refracted
/// into a narrow lobe about it fills a part of its cell only, and where the slab absorbs, a cell of
/// 0.02 in the cosine makes an error of 0.4 % at depth 1.
AngularGrid make_angular_grid(double ior, double critical, int cells);

/// Least-squares fit of a smooth function of the cosine to its means over the cells of a grid:
/// polynomials of sqrt(c) (transmission falls as c at grazing), a set on each side of the
/// critical cosine. Constants are reproduced exactly.
class CellFit {
public:
    explicit CellFit(const AngularGrid& grid);
    /// Coefficients for one vector of cell means.
    Eigen::VectorXd coefficients(const Eigen::VectorXd& cell_means) const;
    double evaluate(const Eigen::VectorXd& coefficients, double cosine) const;
    /// Evaluates several functions, whose coefficients are rows.
    Eigen::VectorXd evaluate_rows(const Eigen::MatrixXd& coefficients, double cosine) const;

private:
    Eigen::VectorXd basis(double cosine) const;

    double critical_;
    int terms_;
    Eigen::MatrixXd solve_; ///< (coefficients, cells)
};

} // namespace reradiant
