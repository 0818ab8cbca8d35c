#include "host/fit/factors/smooth_basis.h"

#include <cmath>
#include <utility>

namespace reradiant {

double cubic_spline(double t) {
    const double a = std::abs(t);
    if (a >= 2.0)
        return 0.0;
    const double outer = 2.0 - a, inner = 1.0 - a;
    return (outer * outer * outer - (a < 1.0 ? 4.0 * inner * inner * inner : 0.0)) / 6.0;
}

SmoothBasis per_band_basis(const WavelengthGrid& grid) {
    return {0.0, Eigen::MatrixXd::Identity(grid.count, grid.count), {}};
}

SmoothBasis spline_basis(const WavelengthGrid& grid, double spacing_nm) {
    if (spacing_nm <= grid.step_nm * (1.0 + 1e-9))
        return per_band_basis(grid);
    const double range_nm = grid.to_nm() - grid.from_nm;
    const auto count = static_cast<Eigen::Index>(std::ceil(range_nm / spacing_nm - 1e-9)) + 3;
    SmoothBasis basis{spacing_nm, Eigen::MatrixXd(grid.count, count), {}};
    for (int band = 0; band < grid.count; ++band)
        for (Eigen::Index j = 0; j < count; ++j)
            basis.values(band, j) = cubic_spline(
                (grid.centre_nm(band) - grid.from_nm) / spacing_nm - static_cast<double>(j - 1));
    return basis;
}

SmoothBasis hat_basis(const WavelengthGrid& grid, std::vector<int> knots) {
    const auto count = static_cast<Eigen::Index>(knots.size());
    SmoothBasis basis{0.0, Eigen::MatrixXd::Zero(grid.count, count), std::move(knots)};
    for (Eigen::Index j = 0; j < count; ++j) {
        const int knot = basis.knots[static_cast<std::size_t>(j)];
        basis.values(knot, j) = 1.0;
        if (j + 1 == count)
            break;
        const int next = basis.knots[static_cast<std::size_t>(j + 1)];
        for (int band = knot + 1; band < next; ++band) {
            const double share = static_cast<double>(band - knot) / (next - knot);
            basis.values(band, j) = 1.0 - share;
            basis.values(band, j + 1) = share;
        }
    }
    return basis;
}

} // namespace reradiant
