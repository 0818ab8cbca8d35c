#include "host/layers/rough/interface_file.h"

#include "host/base/atomic_file.h"
#include "host/base/checksum.h"
#include "host/base/logging.h"
#include "host/base/regular_file.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <cstdint>
#include <cstring>

namespace reradiant {

namespace {

/// This version must be raised when the numbers or the layout of a stored file change.
constexpr std::uint32_t format_version = 7;

std::uint64_t bits_of(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// The kinds by their magic words and by the beginnings of their files' names.
struct Kind {
    const char *magic, *name;
};
Kind kind_of(const InterfaceKey& key) {
    switch (key.kind) {
    case InterfaceNumbers::Operator:
        return {"RRIFACE", ""};
    case InterfaceNumbers::FacetShape:
        return {"RRSHAPE", "shape-"};
    case InterfaceNumbers::LobeRatio:
        break;
    }
    return {"RRRATIO", "ratio-"};
}

struct Header {
    char magic[8];
    std::uint32_t version, count;
    std::int64_t eta_1e4;
    std::int32_t distribution, scattering;
    std::uint64_t alpha_bits, key_checksum, checksum;
};

Header header_of(const InterfaceKey& key, const std::vector<double>& numbers) {
    Header header{};
    std::memcpy(header.magic, kind_of(key).magic, 8);
    header.version = format_version;
    header.count = static_cast<std::uint32_t>(numbers.size());
    header.eta_1e4 = key.eta_1e4;
    header.distribution = static_cast<std::int32_t>(key.interface.distribution);
    header.scattering = static_cast<std::int32_t>(key.interface.scattering);
    header.alpha_bits = bits_of(key.interface.alpha);
    header.key_checksum = checksum_of(key.numbers);
    header.checksum = checksum_of(numbers);
    return header;
}

} // namespace

std::filesystem::path InterfaceKey::file() const {
    if (!numbers.empty())
        return cache_directory() / "interfaces" /
               fmt::format("v{}-{}{:016x}.bin", format_version, kind_of(*this).name,
                           checksum_of(numbers));
    return cache_directory() / "interfaces" /
           fmt::format("v{}-{}{}-{}-{}-{:016x}.bin", format_version, kind_of(*this).name, eta_1e4,
                       static_cast<int>(interface.distribution),
                       static_cast<int>(interface.scattering), bits_of(interface.alpha));
}

std::optional<std::vector<double>> read_interface_file(const std::filesystem::path& file,
                                                       const InterfaceKey& key, std::size_t count) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        return std::nullopt;
    std::ifstream in = open_regular_file(file);
    std::vector<double> numbers(count);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    in.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    const bool whole = in.good() && in.peek() == std::ifstream::traits_type::eof();
    const Header expected = header_of(key, numbers);
    if (!whole || std::memcmp(&header, &expected, sizeof header) != 0) {
        logging::warn("{}: damaged cache file; it is computed again", file.string());
        return std::nullopt;
    }
    return numbers;
}

void write_interface_file(const std::filesystem::path& file, const InterfaceKey& key,
                          const std::vector<double>& numbers) {
    std::filesystem::create_directories(file.parent_path());
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        const Header header = header_of(key, numbers);
        std::ofstream out(temporary, std::ios::binary);
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        out.write(reinterpret_cast<const char*>(numbers.data()),
                  static_cast<std::streamsize>(numbers.size() * sizeof(double)));
        out.close();
        if (!out)
            throw_runtime_error(temporary.string() + " cannot be written");
    });
}

void keep_interface_numbers(const InterfaceKey& key, const std::vector<double>& numbers) {
    try {
        write_interface_file(key.file(), key, numbers);
    } catch (const std::exception& error) {
        logging::debug("interface cache not written: {}", error.what());
    }
}

} // namespace reradiant
