#include "host/layers/rough/interface_operator.h"

#include "host/layers/rough/interface_file.h"

#include <cmath>
#include <map>
#include <mutex>
#include <tuple>
#include <vector>

namespace reradiant {

namespace {

/// The key holds the IOR ratio in units of 1e-4, distribution, scattering and alpha.
using OperatorKey = std::tuple<long, int, int, double>;

OperatorKey key_of(const RoughInterface& interface, long eta_1e4) {
    return {eta_1e4, static_cast<int>(interface.distribution),
            static_cast<int>(interface.scattering), interface.alpha};
}

constexpr Eigen::Index side = 2 * interface_cells;

std::vector<double> numbers_of(const InterfaceOperator& op) {
    std::vector<double> numbers(op.exchange.data(), op.exchange.data() + op.exchange.size());
    numbers.insert(numbers.end(), op.first_lobe.data(),
                   op.first_lobe.data() + op.first_lobe.size());
    return numbers;
}

InterfaceOperator operator_of(const RoughInterface& interface, const std::vector<double>& numbers) {
    InterfaceOperator op = empty_interface_operator(interface);
    op.exchange = Eigen::Map<const Eigen::MatrixXd>(numbers.data(), side, side);
    op.first_lobe =
        Eigen::Map<const Eigen::VectorXd>(numbers.data() + side * side, interface_cells);
    return op;
}

std::shared_ptr<const InterfaceOperator> exact_operator(RoughInterface interface, long eta_1e4) {
    interface.eta = static_cast<double>(eta_1e4) * 1e-4;
    const InterfaceKey key{InterfaceNumbers::Operator, interface, eta_1e4};
    constexpr std::size_t count = side * side + interface_cells;
    if (const auto stored = read_interface_file(key.file(), key, count))
        return std::make_shared<InterfaceOperator>(operator_of(interface, *stored));
    auto op = std::make_shared<InterfaceOperator>(compute_interface_operator(interface));
    keep_interface_numbers(key, numbers_of(*op));
    return op;
}

/// Keeps operators in memory. It computes one at a time, so that a second thread finds the result.
class OperatorStore {
public:
    std::shared_ptr<const InterfaceOperator> get(const RoughInterface& interface, long eta_1e4) {
        const std::scoped_lock lock(mutex_);
        return find(interface, eta_1e4);
    }

private:
    /// Bounds the memory to about 130 MB.
    static constexpr std::size_t capacity = 1000;

    std::shared_ptr<const InterfaceOperator> find(const RoughInterface& interface, long eta_1e4) {
        const OperatorKey key = key_of(interface, eta_1e4);
        if (const auto known = operators_.find(key); known != operators_.end())
            return known->second;
        const bool direct = eta_1e4 % 100 == 0 || eta_1e4 < 10200;
        auto op = direct ? exact_operator(interface, eta_1e4) : interpolate(interface, eta_1e4);
        if (operators_.size() >= capacity)
            operators_.clear();
        operators_[key] = op;
        return op;
    }

    /// Cubic Lagrange interpolation of the exchange, whose cells move with the IOR so that a cell's
    /// meaning does not. The stencil stays above 1, where the interface vanishes with a kink.
    std::shared_ptr<const InterfaceOperator> interpolate(RoughInterface interface, long eta_1e4) {
        const long step = eta_1e4 < 11000 ? 100 : 500;
        const long lowest = eta_1e4 < 11000 ? 10100 : 10500;
        const long first = std::max(eta_1e4 / step * step - step, lowest);
        interface.eta = static_cast<double>(eta_1e4) * 1e-4;
        auto op = std::make_shared<InterfaceOperator>(empty_interface_operator(interface));
        op->exchange.setZero(2 * interface_cells, 2 * interface_cells);
        op->first_lobe.setZero(interface_cells);
        for (long node = 0; node < 4; ++node) {
            double weight = 1.0;
            for (long other = 0; other < 4; ++other) {
                if (other != node) {
                    weight *= static_cast<double>(eta_1e4 - first - other * step) /
                              static_cast<double>((node - other) * step);
                }
            }
            const auto known = find(interface, first + node * step);
            op->exchange += weight * known->exchange;
            op->first_lobe += weight * known->first_lobe;
        }
        op->exchange = op->exchange.cwiseMax(0.0);
        if (interface.scattering == Scattering::Multiple)
            scale_symmetric(op->exchange, op->etendue());
        return op;
    }

    std::mutex mutex_;
    std::map<OperatorKey, std::shared_ptr<const InterfaceOperator>> operators_;
};

} // namespace

std::shared_ptr<const InterfaceOperator> interface_operator(const RoughInterface& interface) {
    static OperatorStore store;
    const long eta_1e4 = std::lround(interface.eta * 1e4);
    return store.get(interface, std::max(eta_1e4, 10001L));
}

} // namespace reradiant
