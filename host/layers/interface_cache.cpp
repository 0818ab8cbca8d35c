#include "host/atomic_file.h"
#include "host/error.h"
#include "host/layers/interface_operator.h"
#include "host/paths.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

namespace reradiant {

namespace {

/// Raise when the numbers or the layout of a stored operator change.
constexpr std::uint32_t format_version = 2;

/// IOR ratio in units of 1e-4, distribution, scattering, bits of alpha.
using OperatorKey = std::tuple<long, int, int, std::uint64_t>;

OperatorKey key_of(const RoughInterface& interface, long eta_1e4) {
    std::uint64_t alpha_bits = 0;
    std::memcpy(&alpha_bits, &interface.alpha, sizeof alpha_bits);
    return {eta_1e4, static_cast<int>(interface.distribution),
            static_cast<int>(interface.scattering), alpha_bits};
}

std::filesystem::path file_of(const OperatorKey& key) {
    return cache_directory() / "interfaces" /
           fmt::format("v{}-{}-{}-{}-{:016x}.bin", format_version, std::get<0>(key),
                       std::get<1>(key), std::get<2>(key), std::get<3>(key));
}

/// FNV-1a, 64 bit.
std::uint64_t checksum_of(const std::vector<double>& numbers) {
    std::uint64_t hash = 1469598103934665603ULL;
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < numbers.size() * sizeof(double); ++i) {
        hash = (hash ^ bytes[i]) * 1099511628211ULL;
    }
    return hash;
}

struct Header {
    char magic[8];
    std::uint32_t version, cells;
    std::int64_t eta_1e4;
    std::int32_t distribution, scattering;
    std::uint64_t alpha_bits, checksum;
};

Header header_of(const OperatorKey& key, std::uint64_t checksum) {
    Header header{};
    std::memcpy(header.magic, "RRIFACE", 8);
    header.version = format_version;
    header.cells = interface_cells;
    header.eta_1e4 = std::get<0>(key);
    header.distribution = std::get<1>(key);
    header.scattering = std::get<2>(key);
    header.alpha_bits = std::get<3>(key);
    header.checksum = checksum;
    return header;
}

std::vector<double> numbers_of(const InterfaceOperator& op) {
    std::vector<double> numbers(op.exchange.data(), op.exchange.data() + op.exchange.size());
    numbers.insert(numbers.end(), op.first_lobe.data(),
                   op.first_lobe.data() + op.first_lobe.size());
    return numbers;
}

/// The stored operator, or nothing when there is none or it is damaged.
std::optional<InterfaceOperator> read_operator(const RoughInterface& interface,
                                               const OperatorKey& key) {
    std::ifstream in(file_of(key), std::ios::binary);
    if (!in) {
        return std::nullopt;
    }
    constexpr auto n = static_cast<std::size_t>(2 * interface_cells);
    std::vector<double> numbers(n * n + interface_cells);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    in.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    const bool whole = in.good() && in.peek() == std::ifstream::traits_type::eof();
    const Header expected = header_of(key, checksum_of(numbers));
    if (!whole || std::memcmp(&header, &expected, sizeof header) != 0) {
        spdlog::warn("{}: damaged cache file; it is computed again", file_of(key).string());
        return std::nullopt;
    }
    InterfaceOperator op = empty_interface_operator(interface);
    op.exchange = Eigen::Map<Eigen::MatrixXd>(numbers.data(), n, n);
    op.first_lobe = Eigen::Map<Eigen::VectorXd>(numbers.data() + n * n, interface_cells);
    return op;
}

/// A cache that cannot be written is no error: it only costs time.
void write_operator(const InterfaceOperator& op, const OperatorKey& key) {
    try {
        std::filesystem::create_directories(file_of(key).parent_path());
        write_atomically(file_of(key), [&](const std::filesystem::path& temporary) {
            const std::vector<double> numbers = numbers_of(op);
            const Header header = header_of(key, checksum_of(numbers));
            std::ofstream out(temporary, std::ios::binary);
            out.write(reinterpret_cast<const char*>(&header), sizeof header);
            out.write(reinterpret_cast<const char*>(numbers.data()),
                      static_cast<std::streamsize>(numbers.size() * sizeof(double)));
            out.close();
            if (!out) {
                throw_runtime_error(temporary.string() + " cannot be written");
            }
        });
    } catch (const std::exception& error) {
        spdlog::debug("interface cache not written: {}", error.what());
    }
}

std::shared_ptr<const InterfaceOperator> exact_operator(RoughInterface interface, long eta_1e4) {
    interface.eta = static_cast<double>(eta_1e4) * 1e-4;
    const OperatorKey key = key_of(interface, eta_1e4);
    if (std::optional<InterfaceOperator> stored = read_operator(interface, key)) {
        return std::make_shared<InterfaceOperator>(std::move(*stored));
    }
    auto op = std::make_shared<InterfaceOperator>(compute_interface_operator(interface));
    write_operator(*op, key);
    return op;
}

/// Memory of operators; one computation at a time, so that a second thread finds the result.
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
        if (const auto known = operators_.find(key); known != operators_.end()) {
            return known->second;
        }
        const bool direct = eta_1e4 % 100 == 0 || eta_1e4 < 10200;
        auto op = direct ? exact_operator(interface, eta_1e4) : interpolate(interface, eta_1e4);
        if (operators_.size() >= capacity) {
            operators_.clear();
        }
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
        if (interface.scattering == Scattering::Multiple) {
            scale_symmetric(op->exchange, op->etendue());
        }
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
