#include "host/exr/exr_header.h"

#include "host/base/regular_file.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

// Technical introduction to OpenEXR, "OpenEXR File Layout": magic number, version, then of every
// part a header, which is a list of attributes (name, type, size, value) that ends with an empty
// name. The headers of a file of several parts end with an empty one.

namespace reradiant {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t multi_part_flag = 0x1000;
constexpr std::size_t longest_name = 255;
constexpr int most_parts = 1024;
constexpr double most_buffer_bytes = 256.0 * (1 << 20);

/// Rows that are packed together, and most bytes of pixels that one of the file can stand for: zlib
/// makes at most 1032 of one, the steps of PIZ and PXR24 up to twice that, and DWA unpacks runs of
/// 64 from what zlib unpacked.
struct Packing {
    double rows, most_ratio;
};
constexpr std::array<Packing, 10> packings{{{1, 2200},
                                            {1, 2200},
                                            {1, 2200},
                                            {16, 2200},
                                            {32, 2200},
                                            {16, 2200},
                                            {32, 2200},
                                            {32, 2200},
                                            {32, 70000},
                                            {256, 70000}}};

/// OpenEXR reads as many bytes as a type has, whatever size the file gives: with another size it
/// would find the next attribute elsewhere.
struct FixedSize {
    std::string_view type;
    std::uint32_t bytes;
};
constexpr FixedSize fixed_sizes[] = {{"box2f", 16},
                                     {"box2i", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"deepImageState", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33d", 72},
                                     {"m33f", 36},
                                     {"m44d", 128},
                                     {"m44f", 64},
                                     {"rational", 8},
                                     {"tiledesc", 9},
                                     {"timecode", 8},
                                     {"v2d", 16},
                                     {"v2f", 8},
                                     {"v2i", 8},
                                     {"v3d", 24},
                                     {"v3f", 12},
                                     {"v3i", 12}};

std::uint32_t number_in(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;)
        value =
            value << 8 | (at + k < bytes.size() ? static_cast<unsigned char>(bytes[at + k]) : 0);
    return value;
}

struct ChannelList {
    double pixel_bytes = 0.0; ///< of all channels together
    bool is_whole = false;    ///< ends with an empty name, where the attribute ends
};
/// Reads a list of channels, which has of every channel its name, a 0, its type (4 bytes; 1 is
/// half) and 12 bytes more.
ChannelList channels_in(std::string_view list) {
    ChannelList channels;
    for (std::size_t at = 0; at < list.size();) {
        if (list[at] == '\0') {
            channels.is_whole = at + 1 == list.size();
            break;
        }
        const std::size_t end = list.find('\0', at);
        if (end == std::string_view::npos || end - at > longest_name)
            break;
        channels.pixel_bytes += number_in(list, end + 1) == 1 ? 2.0 : 4.0;
        at = end + 17;
    }
    return channels;
}

/// Returns whether texts, each behind its length, fill the list exactly.
bool is_whole_text_list(std::string_view list) {
    std::size_t at = 0;
    while (at < list.size())
        at += 4 + std::size_t{number_in(list, at)};
    return at == list.size();
}

/// Returns whether a value is as long as OpenEXR reads for its type.
bool is_whole(std::string_view type, std::string_view value) {
    for (const FixedSize& fixed : fixed_sizes)
        if (type == fixed.type)
            return value.size() == fixed.bytes;
    if (type == "chlist")
        return channels_in(value).is_whole;
    if (type == "stringvector")
        return is_whole_text_list(value);
    if (type == "preview") // width, height, 4 bytes a pixel
        return value.size() >= 8 && 4.0 * number_in(value, 0) * number_in(value, 4) + 8.0 ==
                                        static_cast<double>(value.size());
    return true;
}

/// A `PartSize` is what a header says about the size of its part.
struct PartSize {
    double width = 0.0, height = 0.0, pixel_bytes = 0.0, tile_pixels = 0.0;
    Packing packing = packings.front();

    void take(const std::string& name, std::string_view value) {
        if (name == "channels")
            pixel_bytes = channels_in(value).pixel_bytes;
        if (name == "compression" && !value.empty())
            packing = packings[std::min<std::size_t>(static_cast<unsigned char>(value[0]),
                                                     packings.size() - 1)];
        if (name == "tiles")
            tile_pixels = static_cast<double>(number_in(value, 0)) * number_in(value, 4);
        if (name == "dataWindow") {
            const auto corner = [&](std::size_t at) {
                return static_cast<double>(static_cast<std::int32_t>(number_in(value, at)));
            };
            width = corner(8) - corner(0) + 1.0;
            height = corner(12) - corner(4) + 1.0;
        }
    }
    double bytes() const { return width * height * pixel_bytes; }
    /// Returns the bytes of the rows or the tile that OpenEXR unpacks together.
    double buffer_bytes() const {
        return pixel_bytes * std::max(tile_pixels, packing.rows * width);
    }
};

class HeaderWalk {
public:
    explicit HeaderWalk(const fs::path& file) : file_(file), stream_(open_regular_file(file)) {
        std::error_code failure;
        size_ = fs::file_size(file, failure);
        if (!stream_ || failure)
            throw_input_error({file.string()}, "cannot be opened",
                              "give an EXR file that exists and is readable");
    }

    void check() {
        if (number() != magic)
            refuse("it does not begin like one");
        const bool several = (number() & multi_part_flag) != 0;
        for (int part = 0; check_part() && several; ++part)
            if (part == most_parts)
                refuse(fmt::format("it has more than {} parts", most_parts));
    }

private:
    [[noreturn]] void refuse(const std::string& why) const {
        throw_input_error({file_.string()},
                          fmt::format("is no EXR file, or truncated or damaged ({})", why),
                          "render or copy it again");
    }

    /// Checks the header of one part; returns false for an empty header.
    bool check_part() {
        bool empty = true;
        PartSize part;
        for (std::string name = text(); !name.empty(); name = text()) {
            empty = false;
            const std::string type = text(), held = value(name);
            if (!is_whole(type, held))
                refuse(fmt::format("the attribute {} has {} bytes, which is no {}", name,
                                   held.size(), type));
            part.take(name, held);
        }
        const double most = part.packing.most_ratio * static_cast<double>(size_) + 65536.0;
        if (part.bytes() > most)
            refuse(fmt::format("its header promises {:.0f} bytes of pixels, the file has {}",
                               part.bytes(), size_));
        if (part.buffer_bytes() > std::max(most_buffer_bytes, part.bytes()))
            refuse(fmt::format("its rows or tiles have {:.0f} bytes", part.buffer_bytes()));
        return !empty;
    }

    std::string value(const std::string& name) {
        const std::uint32_t bytes = number();
        const auto left = size_ - static_cast<std::uint64_t>(stream_.tellg());
        if (bytes > left)
            refuse(fmt::format("the attribute {} has {} bytes, {} are left", name, bytes, left));
        std::string value(bytes, '\0');
        stream_.read(value.data(), static_cast<std::streamsize>(bytes));
        return value;
    }

    std::uint32_t number() {
        std::array<char, 4> bytes{};
        stream_.read(bytes.data(), bytes.size());
        if (!stream_)
            refuse("its header is cut off");
        return number_in({bytes.data(), bytes.size()}, 0);
    }

    std::string text() {
        std::string found;
        for (char letter; stream_.get(letter) && found.size() <= longest_name; found += letter)
            if (letter == '\0')
                return found;
        refuse("its header is cut off");
    }

    const fs::path& file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
};

} // namespace

void check_exr_header(const fs::path& file) {
    HeaderWalk(file).check();
}

} // namespace reradiant
