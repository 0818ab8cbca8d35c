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

/// A slab's cells by their cosines, and the equation of transport between them.
struct SlabCellsOfDirection {
    Eigen::VectorXd width, projected; ///< integrals over a cell of 1 and of 2 cos
    Eigen::VectorXd slant;            ///< mean of 1 / cos over its flux
    /// Flux lost and gained per optical depth, by share of each cell's flux: d down / d t = -a down
    /// + b up, -d up / d t = -a up + b down.
    Eigen::MatrixXd a, b;
};

SlabCellsOfDirection transport_between(const AngularGrid& grid, double albedo, double anisotropy) {
    const Eigen::Index n = grid.cells();
    SlabCellsOfDirection cells{Eigen::VectorXd(n), Eigen::VectorXd(n), {}, {}, {}};
    for (Eigen::Index j = 0; j < n; ++j) {
        const double low = grid.edges[static_cast<std::size_t>(j)];
        const double high = grid.edges[static_cast<std::size_t>(j) + 1];
        cells.width(j) = high - low;
        cells.projected(j) = (high - low) * (high + low);
    }
    const std::shared_ptr<const CellPhase> phase = phase_of(grid, anisotropy);
    cells.slant = 2.0 * cells.width.cwiseQuotient(cells.projected);
    const Eigen::VectorXd gain = 2.0 * albedo * cells.projected.cwiseInverse();
    cells.a = Eigen::MatrixXd(cells.slant.asDiagonal()) - phase->forward * gain.asDiagonal();
    cells.b = phase->backward * gain.asDiagonal();
    return cells;
}

/// Layer of an optical depth by the implicit midpoint rule: what goes on within it is the mean of
/// what is at its two faces. Sums and differences of both directions do not mix.
EmittingSlab thin_layer(const SlabCellsOfDirection& cells, double depth) {
    const auto one = Eigen::MatrixXd::Identity(cells.a.rows(), cells.a.cols());
    const Eigen::MatrixXd less = 0.5 * depth * (cells.a - cells.b);
    const Eigen::MatrixXd more = 0.5 * depth * (cells.a + cells.b);
    const Eigen::MatrixXd sum = left_quotient(one + less, one - less);
    const Eigen::MatrixXd difference = left_quotient(one + more, one - more);
    EmittingSlab slab{{0.5 * (sum - difference), 0.5 * (sum + difference)}, {}, 0.0};
    slab.fluence = 0.5 * (cells.slant + sum.transpose() * cells.slant);
    slab.own_fluence = 0.25 * cells.slant.cwiseProduct(slab.fluence).dot(cells.projected);
    return slab;
}

/// Two of the same slab, one above the other.
EmittingSlab doubled(const EmittingSlab& slab, const Eigen::VectorXd& projected) {
    const Eigen::MatrixXd &back = slab.op.back, &through = slab.op.through;
    const auto one = Eigen::MatrixXd::Identity(back.rows(), back.cols());
    const Eigen::MatrixXd between = left_quotient(one - back * back, through);
    EmittingSlab twice{{back + through * back * between, through * between}, {}, 0.0};
    // by symmetry each half sends the other what it gets from it
    const Eigen::VectorXd sent = 0.25 * slab.fluence.cwiseProduct(projected);
    const Eigen::VectorXd exchanged = left_quotient(one - back, sent);
    const Eigen::VectorXd leaving = 0.5 * (sent + through * exchanged);
    twice.fluence = 4.0 * leaving.cwiseQuotient(projected);
    twice.own_fluence = 0.5 * (slab.own_fluence + slab.fluence.dot(exchanged));
    return twice;
}

EmittingSlab slab_by_doubling(const SlabCellsOfDirection& cells, double depth) {
    const double first = 0.5 / cells.slant.maxCoeff();
    const int doublings = std::max(static_cast<int>(std::ceil(std::log2(depth / first))), 0);
    EmittingSlab slab = thin_layer(cells, std::ldexp(depth, -doublings));
    for (int k = 0; k < doublings; ++k)
        slab = doubled(slab, cells.projected);
    return slab;
}

} // namespace

SlabOperator scattering_slab(const AngularGrid& grid, double tau, double tau_scattering,
                             double anisotropy) {
    const double total = tau + tau_scattering;
    const SlabCellsOfDirection cells = transport_between(grid, tau_scattering / total, anisotropy);
    SlabOperator slab = slab_by_doubling(cells, total).op;
    if (tau == 0.0) { // rounding grows with every doubling
        const Eigen::Index n = grid.cells();
        const Eigen::VectorXd& projected = cells.projected;
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

std::vector<EmittingSlab> emitting_slabs(const AngularGrid& grid, double tau, double tau_scattering,
                                         double anisotropy, int count) {
    const double total = tau + tau_scattering;
    const SlabCellsOfDirection cells = transport_between(grid, tau_scattering / total, anisotropy);
    std::vector<EmittingSlab> slabs{slab_by_doubling(cells, total)};
    while (static_cast<int>(slabs.size()) < count)
        slabs.push_back(doubled(slabs.back(), cells.projected));
    return slabs;
}

} // namespace reradiant
