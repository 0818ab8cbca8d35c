#include "host/layers/angular/scattering_slab.h"

#include "host/layers/rough/interface_operator.h"
#include "host/spectral/matrix/linear_systems.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

namespace reradiant {

namespace {

/// Phase function between cells, forwards and backwards: the integral of p(mu, mu') dmu dmu' with
/// the integral of p over mu from -1 to 1 equal to 1. Symmetric.
struct CellPhase {
    Eigen::MatrixXd forward, backward;
};

/// Terms of the Legendre series: until g^l is nothing, and at most what |g| = 0.999 needs.
int legendre_terms(double g) {
    if (g == 0.0)
        return 1;
    return static_cast<int>(
               std::clamp(std::ceil(std::log(1e-13) / std::log(std::fabs(g))), 1.0, 30000.0)) +
           1;
}

CellPhase integrate_phase(const AngularGrid& grid, double g) {
    const Eigen::Index n = grid.cells();
    CellPhase phase{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
    const Eigen::Map<const Eigen::ArrayXd> x(grid.edges.data(), n + 1);
    Eigen::ArrayXd before = Eigen::ArrayXd::Ones(n + 1); // P_(l - 1), P_0 for l = 0
    Eigen::ArrayXd legendre = before;
    double power = 1.0;
    const int terms = legendre_terms(g);
    for (int l = 0; l < terms; ++l) {
        const Eigen::ArrayXd after =
            l == 0 ? Eigen::ArrayXd(x)
                   : Eigen::ArrayXd(((2 * l + 1) * x * legendre - l * before) / (l + 1));
        // integral of P_l = (P_(l + 1) - P_(l - 1)) / (2l + 1)
        const Eigen::ArrayXd integral =
            l == 0 ? Eigen::ArrayXd(x) : Eigen::ArrayXd((after - before) / (2 * l + 1));
        const Eigen::VectorXd cells = (integral.tail(n) - integral.head(n)).matrix();
        const double even = 0.5 * (2 * l + 1) * power;
        phase.forward.noalias() += even * cells * cells.transpose();
        phase.backward.noalias() += (l % 2 == 0 ? even : -even) * cells * cells.transpose();
        before = legendre;
        legendre = after;
        power *= g;
    }
    return phase;
}

/// The last phase functions: slabs differ in optical depth from band to band, not in g.
std::shared_ptr<const CellPhase> phase_of(const AngularGrid& grid, double g) {
    static std::mutex mutex;
    static std::map<std::tuple<std::vector<double>, double>, std::shared_ptr<const CellPhase>>
        known;
    const std::scoped_lock lock(mutex);
    if (known.size() > 64)
        known.clear();
    auto& phase = known[{grid.edges, g}];
    if (!phase)
        phase = std::make_shared<CellPhase>(integrate_phase(grid, g));
    return phase;
}

/// Layer of optical depth `depth`: d down / d t = -a down + b up, -d up / d t = -a up + b down,
/// with the implicit midpoint rule. Sums and differences of both directions do not mix.
SlabOperator thin_layer(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double depth) {
    const auto one = Eigen::MatrixXd::Identity(a.rows(), a.cols());
    const Eigen::MatrixXd less = 0.5 * depth * (a - b), more = 0.5 * depth * (a + b);
    const Eigen::MatrixXd sum = left_quotient(one + less, one - less);
    const Eigen::MatrixXd difference = left_quotient(one + more, one - more);
    return {0.5 * (sum - difference), 0.5 * (sum + difference)};
}

} // namespace

SlabOperator scattering_slab(const AngularGrid& grid, double tau, double tau_scattering,
                             double anisotropy) {
    const Eigen::Index n = grid.cells();
    const std::shared_ptr<const CellPhase> phase = phase_of(grid, anisotropy);
    Eigen::VectorXd width(n), projected(n); // of mu and of mu^2
    for (Eigen::Index j = 0; j < n; ++j) {
        const double low = grid.edges[static_cast<std::size_t>(j)];
        const double high = grid.edges[static_cast<std::size_t>(j) + 1];
        width(j) = high - low;
        projected(j) = (high - low) * (high + low);
    }
    const double total = tau + tau_scattering;
    // flux lost and gained per unit of optical depth, by share of each cell's flux
    const Eigen::VectorXd slant = 2.0 * width.cwiseQuotient(projected);
    const Eigen::VectorXd gain = 2.0 * tau_scattering / total * projected.cwiseInverse();
    const Eigen::MatrixXd a =
        Eigen::MatrixXd(slant.asDiagonal()) - phase->forward * gain.asDiagonal();
    const Eigen::MatrixXd b = phase->backward * gain.asDiagonal();
    const double first = 0.5 / slant.maxCoeff();
    const int doublings = std::max(static_cast<int>(std::ceil(std::log2(total / first))), 0);
    SlabOperator slab = thin_layer(a, b, std::ldexp(total, -doublings));
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
    for (int k = 0; k < doublings; ++k) {
        const Eigen::MatrixXd between = left_quotient(one - slab.back * slab.back, slab.through);
        slab.back += slab.through * slab.back * between;
        slab.through = slab.through * between;
    }
    if (tau == 0.0) { // rounding grows with every doubling
        Eigen::MatrixXd exchange(2 * n, 2 * n);
        const Eigen::MatrixXd back = slab.back * projected.asDiagonal();
        const Eigen::MatrixXd through = slab.through * projected.asDiagonal();
        exchange << back, through, through, back;
        exchange = exchange.cwiseMax(0.0);
        scale_symmetric(exchange, projected.replicate(2, 1));
        slab.back = exchange.topLeftCorner(n, n) * projected.cwiseInverse().asDiagonal();
        slab.through = exchange.topRightCorner(n, n) * projected.cwiseInverse().asDiagonal();
    }
    return slab;
}

} // namespace reradiant
