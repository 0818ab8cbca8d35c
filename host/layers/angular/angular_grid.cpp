#include "host/layers/angular/angular_grid.h"

#include "host/layers/stack/quadrature.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

int AngularGrid::cell_of(double cosine) const {
    const auto above = std::upper_bound(edges.begin(), edges.end(), cosine);
    return std::clamp(static_cast<int>(above - edges.begin()) - 1, 0, cells() - 1);
}

Eigen::VectorXd AngularGrid::etendue() const {
    Eigen::VectorXd e(cells());
    for (int j = 0; j < cells(); ++j) {
        const double low = edges[static_cast<std::size_t>(j)];
        const double high = edges[static_cast<std::size_t>(j) + 1];
        e(j) = ior * ior * (high - low) * (high + low);
    }
    return e;
}

std::vector<double> AngularGrid::invariants() const {
    std::vector<double> q;
    for (const double c : edges)
        q.push_back(ior * ior * (1.0 - c) * (1.0 + c));
    return q;
}

AngularGrid make_angular_grid(double ior, double critical, int cells) {
    AngularGrid grid{ior, critical, {}};
    const auto share = [](int j, int count) { // 0 to 1, crowded at both ends
        const double s = std::sin(0.5 * std::numbers::pi * j / count);
        return s * s;
    };
    if (critical <= 0.0) {
        for (int j = 0; j <= cells; ++j)
            grid.edges.push_back(share(j, cells));
        return grid;
    }
    const int lower = cells / 2, upper = cells - lower;
    for (int j = 0; j < lower; ++j)
        grid.edges.push_back(critical * std::sin(0.5 * std::numbers::pi * j / lower));
    for (int j = 0; j <= upper; ++j)
        grid.edges.push_back(critical + (1.0 - critical) * share(j, upper));
    grid.edges.back() = 1.0;
    return grid;
}

CellFit::CellFit(const AngularGrid& grid)
    : critical_(grid.critical), terms_(grid.critical > 0.0 ? 11 : 15) {
    const int sets = critical_ > 0.0 ? 2 : 1;
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(grid.cells(), sets * terms_);
    const Quadrature& rule = gauss_legendre(8);
    for (int j = 0; j < grid.cells(); ++j) {
        const double low = grid.edges[static_cast<std::size_t>(j)];
        const double width = grid.edges[static_cast<std::size_t>(j) + 1] - low;
        double total = 0.0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double c = low + width * rule.nodes[i];
            means.row(j) += rule.weights[i] * c * basis(c).transpose();
            total += rule.weights[i] * c;
        }
        means.row(j) /= total;
    }
    solve_ =
        means.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(grid.cells(), grid.cells()));
}

Eigen::VectorXd CellFit::basis(double cosine) const {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const bool upper = c >= critical_;
    const double x = upper ? std::sqrt((c - critical_) / (1.0 - critical_))
                           : std::asin(c / critical_) / (0.5 * std::numbers::pi);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(critical_ > 0.0 ? 2 * terms_ : terms_);
    const int first = critical_ > 0.0 && upper ? terms_ : 0;
    // Chebyshev polynomials on [-1, 1]: well conditioned
    const double t = 2.0 * x - 1.0;
    double previous = 1.0, current = t;
    for (int k = 0; k < terms_; ++k) {
        values(first + k) = k == 0 ? 1.0 : current;
        if (k > 0) {
            const double next = 2.0 * t * current - previous;
            previous = current;
            current = next;
        }
    }
    return values;
}

Eigen::VectorXd CellFit::coefficients(const Eigen::VectorXd& cell_means) const {
    return solve_ * cell_means;
}

double CellFit::evaluate(const Eigen::VectorXd& coefficients, double cosine) const {
    return coefficients.dot(basis(cosine));
}

Eigen::VectorXd CellFit::evaluate_rows(const Eigen::MatrixXd& coefficients, double cosine) const {
    return coefficients * basis(cosine);
}

} // namespace reradiant
