#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reradiant {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::size_t ply_type_size(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    bool is_list = false;
    PlyType count_type = PlyType::Uint8;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    int line = 0; ///< of its declaration
    std::vector<PlyProperty> properties;

    /// Returns the index of a property, or -1 when there is none of that name.
    int index_of(std::string_view property) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0; ///< bytes up to and with the line end_header
    int line_count = 0;
};

/// Reads the header. Input Error with its line for anything not understood, and for counts that
/// the rest of the file cannot hold (one byte and a separator a value in ascii).
PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes);

} // namespace reradiant
