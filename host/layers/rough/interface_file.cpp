#include "host/layers/rough/interface_file.h"

#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/base/regular_file.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace reradiant {

namespace {

/// This version must be raised when the numbers or the layout of a stored operator change.
constexpr std::uint32_t format_version = 3;
constexpr auto side = 2 * static_cast<std::size_t>(interface_cells);

std::uint64_t bits_of(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// FNV-1a, 64 bit.
std::uint64_t checksum_of(const std::vector<double>& numbers) {
    std::uint64_t hash = 1469598103934665603ULL;
    const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < numbers.size() * sizeof(double); ++i)
        hash = (hash ^ bytes[i]) * 1099511628211ULL;
    return hash;
}

struct Header {
    char magic[8];
    std::uint32_t version, cells;
    std::int64_t eta_1e4;
    std::int32_t distribution, scattering;
    std::uint64_t alpha_bits, checksum;
};

Header header_of(const RoughInterface& interface, long eta_1e4, std::uint64_t checksum) {
    Header header{};
    std::memcpy(header.magic, "RRIFACE", 8);
    header.version = format_version;
    header.cells = interface_cells;
    header.eta_1e4 = eta_1e4;
    header.distribution = static_cast<std::int32_t>(interface.distribution);
    header.scattering = static_cast<std::int32_t>(interface.scattering);
    header.alpha_bits = bits_of(interface.alpha);
    header.checksum = checksum;
    return header;
}

std::vector<double> numbers_of(const InterfaceOperator& op) {
    std::vector<double> numbers(op.exchange.data(), op.exchange.data() + op.exchange.size());
    numbers.insert(numbers.end(), op.first_lobe.data(),
                   op.first_lobe.data() + op.first_lobe.size());
    return numbers;
}

} // namespace

std::filesystem::path interface_file(const RoughInterface& interface, long eta_1e4) {
    return cache_directory() / "interfaces" /
           fmt::format("v{}-{}-{}-{}-{:016x}.bin", format_version, eta_1e4,
                       static_cast<int>(interface.distribution),
                       static_cast<int>(interface.scattering), bits_of(interface.alpha));
}

std::optional<InterfaceOperator> read_interface_file(const std::filesystem::path& file,
                                                     const RoughInterface& interface,
                                                     long eta_1e4) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        return std::nullopt;
    std::ifstream in = open_regular_file(file);
    std::vector<double> numbers(side * side + interface_cells);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    in.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    const bool whole = in.good() && in.peek() == std::ifstream::traits_type::eof();
    const Header expected = header_of(interface, eta_1e4, checksum_of(numbers));
    if (!whole || std::memcmp(&header, &expected, sizeof header) != 0) {
        logging::warn("{}: damaged cache file; it is computed again", file.string());
        return std::nullopt;
    }
    InterfaceOperator op = empty_interface_operator(interface);
    op.exchange = Eigen::Map<Eigen::MatrixXd>(numbers.data(), side, side);
    op.first_lobe = Eigen::Map<Eigen::VectorXd>(numbers.data() + side * side, interface_cells);
    return op;
}

void write_interface_file(const std::filesystem::path& file, const InterfaceOperator& op,
                          long eta_1e4) {
    std::filesystem::create_directories(file.parent_path());
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        const std::vector<double> numbers = numbers_of(op);
        const Header header = header_of(op.interface, eta_1e4, checksum_of(numbers));
        std::ofstream out(temporary, std::ios::binary);
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        out.write(reinterpret_cast<const char*>(numbers.data()),
                  static_cast<std::streamsize>(numbers.size() * sizeof(double)));
        out.close();
        if (!out)
            throw_runtime_error(temporary.string() + " cannot be written");
    });
}

} // namespace reradiant
