#include "host/report/data_uri.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <cstdint>
#include <fstream>
#include <iterator>

namespace reradiant {

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

std::string png_data_uri(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty())
        throw_runtime_error(fmt::format("{}: the picture cannot be read back", file.string()));
    return "data:image/png;base64," + base64(bytes);
}

} // namespace reradiant
