#include "host/layers/rough/interface_operator.h"

#include "host/base/logging.h"
#include "host/layers/rough/interface_file.h"

#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

namespace reradiant {

namespace {

/// The key holds the IOR ratio in units of 1e-4, distribution, scattering and alpha.
using OperatorKey = std::tuple<long, int, int, double>;

OperatorKey key_of(const RoughInterface& interface, long eta_1e4) {
    return {eta_1e4, static_cast<int>(interface.distribution),
            static_cast<int>(interface.scattering), interface.alpha};
}

/// Writes an operator to the disk cache. A cache that cannot be written is no error: it only costs
/// time.
void keep(const InterfaceOperator& op, const std::filesystem::path& file, long eta_1e4) {
    try {
        write_interface_file(file, op, eta_1e4);
    } catch (const std::exception& error) {
        logging::debug("interface cache not written: {}", error.what());
    }
}

std::shared_ptr<const InterfaceOperator> exact_operator(RoughInterface interface, long eta_1e4) {
    interface.eta = static_cast<double>(eta_1e4) * 1e-4;
    const std::filesystem::path file = interface_file(interface, eta_1e4);
    if (std::optional<InterfaceOperator> stored = read_interface_file(file, interface, eta_1e4))
        return std::make_shared<InterfaceOperator>(std::move(*stored));
    auto op = std::make_shared<InterfaceOperator>(compute_interface_operator(interface));
    keep(*op, file, eta_1e4);
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
