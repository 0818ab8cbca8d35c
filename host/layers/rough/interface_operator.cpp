#include "host/layers/rough/interface_operator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace reradiant {

namespace {

/// Estimates the column of one cell: shares of its flux by cell of departure, times its etendue.
/// Returns the mean of the first reflection lobe.
double estimate_column(const InterfaceOperator& op, int cell, Eigen::VectorXd& column) {
    const int above = op.above.cells();
    const bool from_below = cell >= above;
    const AngularGrid& own = from_below ? op.below : op.above;
    const AngularGrid& other = from_below ? op.above : op.below;
    const int own_first = from_below ? above : 0, other_first = from_below ? 0 : above;
    const auto k = static_cast<std::size_t>(cell - own_first);
    const double low2 = own.edges[k] * own.edges[k];
    const double high2 = own.edges[k + 1] * own.edges[k + 1];
    std::vector<Departure> departures;
    double lobe = 0.0;
    column.setZero();
    const LatticeRule rule = lattice_rule(op.interface);
    const WalkStream stream(rule, static_cast<unsigned>(cell));
    for (unsigned walk = 0; walk < rule.count; ++walk) {
        WalkNumbers numbers(stream, walk);
        // uniform in c^2: uniform in flux
        const double cosine = std::sqrt(low2 + (high2 - low2) * numbers.next());
        departures.clear();
        lobe += scatter_at_interface(op.interface, from_below, std::min(cosine, 1.0), numbers,
                                     departures);
        for (const Departure& d : departures) {
            const int to = d.same_side ? own_first + own.cell_of(d.cosine)
                                       : other_first + other.cell_of(d.cosine);
            column(to) += d.share;
        }
    }
    const double e = own.ior * own.ior * (high2 - low2);
    column *= e / rule.count;
    return lobe / rule.count;
}

/// Combines the estimates of every entry from both ends. The variance of the estimate from cell j
/// is proportional to j's etendue, so each weight is the other cell's etendue.
void symmetrise(Eigen::MatrixXd& matrix, const Eigen::VectorXd& e) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        for (Eigen::Index i = 0; i < j; ++i) {
            const double s = (e(i) * matrix(i, j) + e(j) * matrix(j, i)) / (e(i) + e(j));
            matrix(i, j) = s;
            matrix(j, i) = s;
        }
    }
}

/// Scales a non-negative matrix to D S E with the given column and row sums (Sinkhorn 1967); the
/// two must have the same total. Rows and columns without any entry stay zero.
void scale_to_marginals(Eigen::MatrixXd& matrix, const Eigen::VectorXd& rows,
                        const Eigen::VectorXd& columns) {
    const auto ratio = [](const Eigen::VectorXd& wanted, const Eigen::VectorXd& sums) {
        return Eigen::VectorXd(
            (sums.array() > 0.0).select(wanted.array() / sums.array().max(1e-300), 1.0));
    };
    for (int step = 0; step < 300; ++step) {
        matrix = (ratio(rows, matrix.rowwise().sum()).asDiagonal() * matrix).eval();
        const Eigen::VectorXd change = ratio(columns, matrix.colwise().sum().transpose());
        matrix = (matrix * change.asDiagonal()).eval();
        if ((change.array() - 1.0).abs().maxCoeff() < 1e-10)
            break;
    }
}

/// Makes every block's sums those of the cells' own estimates: how a cell's flux splits between
/// reflection and transmission is known far better than where it goes, and the averaging of both
/// ends' estimates must not blur it. `reflected` and `transmitted`: flux of each cell.
void restore_splits(InterfaceOperator& op, const Eigen::VectorXd& reflected,
                    Eigen::VectorXd transmitted) {
    const Eigen::Index n = op.above.cells(), m = op.below.cells();
    // the same flux goes both ways: share the difference of the two totals
    const double down = transmitted.head(n).sum(), up = transmitted.tail(m).sum();
    if (down > 0.0 && up > 0.0) {
        transmitted.head(n) *= std::sqrt(up / down);
        transmitted.tail(m) *= std::sqrt(down / up);
        Eigen::MatrixXd through = op.exchange.bottomLeftCorner(m, n);
        scale_to_marginals(through, transmitted.tail(m), transmitted.head(n));
        op.exchange.bottomLeftCorner(m, n) = through;
        op.exchange.topRightCorner(n, m) = through.transpose();
    }
    Eigen::MatrixXd block = op.exchange.topLeftCorner(n, n);
    scale_symmetric(block, reflected.head(n));
    op.exchange.topLeftCorner(n, n) = block;
    block = op.exchange.bottomRightCorner(m, m);
    scale_symmetric(block, reflected.tail(m));
    op.exchange.bottomRightCorner(m, m) = block;
}

/// Puts back what single scattering loses, reciprocally.
void add_lost_flux(Eigen::MatrixXd& matrix, const Eigen::VectorXd& target) {
    const Eigen::VectorXd lost = (target - matrix.colwise().sum().transpose()).cwiseMax(0.0);
    const double total = lost.sum();
    if (total > 0.0)
        matrix += lost * lost.transpose() / total;
}

} // namespace

Eigen::VectorXd InterfaceOperator::etendue() const {
    Eigen::VectorXd e(above.cells() + below.cells());
    e << above.etendue(), below.etendue();
    return e;
}

void scale_symmetric(Eigen::MatrixXd& matrix, const Eigen::VectorXd& target) {
    Eigen::VectorXd d = Eigen::VectorXd::Ones(target.size());
    for (int step = 0; step < 500; ++step) {
        const Eigen::VectorXd sums = d.cwiseProduct(matrix * d);
        const Eigen::VectorXd ratio =
            (sums.array() > 0.0).select(target.array() / sums.array().max(1e-300), 1.0);
        d = d.cwiseProduct(ratio.cwiseSqrt());
        if ((ratio.array() - 1.0).abs().maxCoeff() < 1e-14)
            break;
    }
    const Eigen::MatrixXd scaled = d.asDiagonal() * matrix * d.asDiagonal();
    matrix = 0.5 * (scaled + scaled.transpose()); // the two products round differently
}

InterfaceOperator empty_interface_operator(const RoughInterface& interface) {
    const double eta = interface.eta;
    const double critical = std::sqrt((eta - 1.0) * (eta + 1.0)) / eta;
    return {interface,
            make_angular_grid(1.0, 0.0, interface_cells),
            make_angular_grid(eta, critical, interface_cells),
            {},
            {}};
}

InterfaceOperator compute_interface_operator(const RoughInterface& interface) {
    InterfaceOperator op = empty_interface_operator(interface);
    const int cells = op.above.cells() + op.below.cells();
    op.exchange.resize(cells, cells);
    Eigen::VectorXd lobes(cells);
    // isolated: a caller's own parallel loop must not be entered here, while the store is locked
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<int>(0, cells, 1), [&](const auto& range) {
            Eigen::VectorXd column(cells);
            for (int j = range.begin(); j != range.end(); ++j) {
                lobes(j) = estimate_column(op, j, column);
                op.exchange.col(j) = column;
            }
        });
    });
    op.first_lobe = lobes.head(op.above.cells());
    const Eigen::VectorXd e = op.etendue();
    const Eigen::Index n = op.above.cells(), m = op.below.cells();
    Eigen::VectorXd reflected(n + m), transmitted(n + m);
    reflected << op.exchange.topLeftCorner(n, n).colwise().sum().transpose(),
        op.exchange.bottomRightCorner(m, m).colwise().sum().transpose();
    transmitted << op.exchange.bottomLeftCorner(m, n).colwise().sum().transpose(),
        op.exchange.topRightCorner(n, m).colwise().sum().transpose();
    symmetrise(op.exchange, e);
    restore_splits(op, reflected, transmitted);
    if (interface.scattering == Scattering::Multiple) {
        if (interface.distribution == Distribution::Blinn)
            add_lost_flux(op.exchange, e);
        scale_symmetric(op.exchange, e);
    }
    return op;
}

} // namespace reradiant
