#include "host/scene/mesh_io.h"
#include "host/scene/ply_header.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

namespace reradiant {

namespace {

/// The values after the header one by one, whatever the format.
class PlyValues {
public:
    PlyValues(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file.string()), bytes_(bytes), format_(header.format), next_(header.size),
          line_(header.line_count + 1), line_start_(header.size) {}

    /// The next value; integers up to 32 bits are exact as double.
    double next(PlyType type, const std::string& what) {
        return format_ == PlyFormat::Ascii ? next_ascii(what) : next_binary(type, what);
    }
    std::size_t remaining() const { return bytes_.size() - next_; }
    /// Line and column of the last value (ascii), else the file.
    SourcePosition position() const {
        if (format_ != PlyFormat::Ascii)
            return {file_};
        return {file_, line_, static_cast<int>(start_ - line_start_) + 1};
    }
    /// " at byte N" for binary files, whose errors have no line.
    std::string byte_text() const {
        return format_ == PlyFormat::Ascii ? "" : fmt::format(" (at byte {})", start_);
    }

private:
    double next_ascii(const std::string& what);
    double next_binary(PlyType type, const std::string& what);
    template <typename T>
    double decode(const unsigned char* bytes) const {
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return static_cast<double>(value);
    }

    std::string file_;
    std::string_view bytes_;
    PlyFormat format_;
    std::size_t next_, start_ = 0;
    int line_;
    std::size_t line_start_;
};

double PlyValues::next_ascii(const std::string& what) {
    while (next_ < bytes_.size() && std::strchr(" \t\r\n", bytes_[next_]) != nullptr) {
        if (bytes_[next_] == '\n') {
            ++line_;
            line_start_ = next_ + 1;
        }
        ++next_;
    }
    start_ = next_;
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", next_), bytes_.size());
    const std::string_view token = bytes_.substr(start_, end - start_);
    next_ = end;
    if (token.empty())
        throw_input_error(position(), fmt::format("the file ends before {}", what),
                          "the file is truncated or a count is wrong");
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (failure == std::errc::result_out_of_range)
        return std::numeric_limits<double>::infinity();
    if (failure != std::errc() || stop != token.data() + token.size())
        throw_input_error(position(), fmt::format("{} is \"{}\"", what, token.substr(0, 40)),
                          "write a number");
    return value;
}

double PlyValues::next_binary(PlyType type, const std::string& what) {
    const std::size_t size = ply_type_size(type);
    start_ = next_;
    if (remaining() < size)
        throw_input_error({file_}, fmt::format("the file ends before {}{}", what, byte_text()),
                          "the file is truncated or a count is wrong");
    std::array<unsigned char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + next_, size);
    next_ += size;
    if ((format_ == PlyFormat::BigEndian) != (std::endian::native == std::endian::big))
        std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    switch (type) {
    case PlyType::Int8:
        return decode<std::int8_t>(raw.data());
    case PlyType::Uint8:
        return decode<std::uint8_t>(raw.data());
    case PlyType::Int16:
        return decode<std::int16_t>(raw.data());
    case PlyType::Uint16:
        return decode<std::uint16_t>(raw.data());
    case PlyType::Int32:
        return decode<std::int32_t>(raw.data());
    case PlyType::Uint32:
        return decode<std::uint32_t>(raw.data());
    case PlyType::Float32:
        return decode<float>(raw.data());
    default:
        return decode<double>(raw.data());
    }
}

/// Turns the elements of a PLY file into a mesh.
class PlyReader {
public:
    PlyReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file.string()), header_(read_ply_header(file, bytes)),
          values_(file, bytes, header_) {}

    MeshShape read();

private:
    void read_vertices(const PlyElement& element);
    void store_vertex(const std::string& name, const std::vector<double>& values,
                      const std::array<int, 8>& columns);
    void read_faces(const PlyElement& element);
    void read_corners(const PlyProperty& property, std::uint64_t face);
    void skip(const PlyElement& element);
    std::uint64_t read_list_size(const PlyProperty& property, const std::string& what);
    [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const {
        throw_input_error(values_.position(), wrong + values_.byte_text(), remedy);
    }

    std::string file_;
    PlyHeader header_;
    PlyValues values_;
    std::uint64_t vertex_count_ = 0;
    std::vector<std::uint32_t> corners_;
    MeshShape mesh_;
};

std::uint64_t PlyReader::read_list_size(const PlyProperty& property, const std::string& what) {
    const double size = values_.next(property.count_type, fmt::format("the count of {}", what));
    // In ascii a value takes two bytes, in binary its size; one byte bounds both.
    if (!(size >= 0.0) || size != std::floor(size) ||
        size > static_cast<double>(values_.remaining()))
        fail(fmt::format("the count of {} is {}", what, size),
             fmt::format("it must be a whole number that fits in the {} bytes left",
                         values_.remaining()));
    return static_cast<std::uint64_t>(size);
}

void PlyReader::store_vertex(const std::string& name, const std::vector<double>& values,
                             const std::array<int, 8>& columns) {
    static const std::array<const char*, 8> labels{"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] < 0)
            continue;
        const float value =
            mesh_coordinate(values[static_cast<std::size_t>(columns[i])], values_.position(),
                            fmt::format("{} of {}{}", labels[i], name, values_.byte_text()));
        (i < 3   ? mesh_.positions
         : i < 6 ? mesh_.normals
                 : mesh_.texture_coordinates)
            .push_back(value);
    }
}

void PlyReader::read_vertices(const PlyElement& element) {
    const auto column = [&](std::initializer_list<const char*> names) {
        for (const char* name : names)
            if (const int index = element.index_of(name); index >= 0)
                return index;
        return -1;
    };
    std::array<int, 8> columns{column({"x"}),
                               column({"y"}),
                               column({"z"}),
                               column({"nx"}),
                               column({"ny"}),
                               column({"nz"}),
                               column({"u", "s", "texture_u"}),
                               column({"v", "t", "texture_v"})};
    if (columns[0] < 0 || columns[1] < 0 || columns[2] < 0)
        throw_input_error({file_, element.line, 1}, "vertices have no x, y and z",
                          "declare property float x, y and z");
    if (columns[3] < 0 || columns[4] < 0 || columns[5] < 0)
        columns[3] = columns[4] = columns[5] = -1;
    if (columns[6] < 0 || columns[7] < 0)
        columns[6] = columns[7] = -1;
    vertex_count_ = element.count;
    std::vector<double> values(element.properties.size());
    for (std::uint64_t vertex = 0; vertex < element.count; ++vertex) {
        const std::string name = fmt::format("vertex {}", vertex);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (element.properties[i].is_list)
                throw_input_error({file_, element.line, 1}, "vertices have a list property",
                                  "remove it");
            values[i] = values_.next(element.properties[i].type, name);
        }
        store_vertex(name, values, columns);
    }
}

void PlyReader::read_corners(const PlyProperty& property, std::uint64_t face) {
    const std::uint64_t size = read_list_size(property, fmt::format("face {}", face));
    if (size < 3)
        fail(fmt::format("face {} has {} corners", face, size), "a face has at least 3");
    corners_.clear();
    for (std::uint64_t i = 0; i < size; ++i) {
        const double index = values_.next(property.type, fmt::format("face {}", face));
        if (!(index >= 0.0 && index < static_cast<double>(vertex_count_)) ||
            index != std::floor(index))
            fail(fmt::format("face {} refers to vertex {} of {}", face, index, vertex_count_),
                 "vertices count from 0");
        corners_.push_back(static_cast<std::uint32_t>(index));
    }
    append_fan(corners_, mesh_);
}

void PlyReader::skip(const PlyElement& element) {
    if (element.properties.empty())
        return;
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties) {
            const std::uint64_t size =
                property.is_list ? read_list_size(property, element.name) : 1;
            for (std::uint64_t k = 0; k < size; ++k)
                values_.next(property.type, fmt::format("{} {}", element.name, i));
        }
}

void PlyReader::read_faces(const PlyElement& element) {
    int corners = element.index_of("vertex_indices");
    if (corners < 0)
        corners = element.index_of("vertex_index");
    if (corners < 0 || !element.properties[static_cast<std::size_t>(corners)].is_list)
        throw_input_error({file_, element.line, 1}, "faces have no list vertex_indices",
                          "declare property list uchar int vertex_indices");
    for (std::uint64_t face = 0; face < element.count; ++face)
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (i == static_cast<std::size_t>(corners)) {
                read_corners(property, face);
                continue;
            }
            const std::string what = fmt::format("face {}", face);
            const std::uint64_t size = property.is_list ? read_list_size(property, what) : 1;
            for (std::uint64_t k = 0; k < size; ++k)
                values_.next(property.type, what);
        }
}

MeshShape PlyReader::read() {
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
        if (element.count > std::numeric_limits<std::uint32_t>::max() - 1)
            throw_input_error({file_, element.line, 1},
                              fmt::format("{} elements {}", element.count, element.name),
                              "at most 4294967294 are read");
        if (element.name == "vertex" && !has_vertices) {
            read_vertices(element);
            has_vertices = true;
        } else if (element.name == "face") {
            if (!has_vertices)
                throw_input_error({file_, element.line, 1}, "faces stand before the vertices",
                                  "write the vertices first");
            read_faces(element);
        } else {
            skip(element);
        }
    }
    return std::move(mesh_);
}

} // namespace

MeshShape parse_ply(const std::filesystem::path& file, std::string_view bytes) {
    return PlyReader(file, bytes).read();
}

} // namespace reradiant
