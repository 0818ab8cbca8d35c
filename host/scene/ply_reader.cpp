#include "host/scene/mesh_io.h"
#include "host/scene/ply_header.h"
#include "host/scene/table_reader.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

namespace reradiant {

namespace {

/// What a value belongs to, made into text for an error only.
struct PlyItem {
    std::string_view element;
    std::uint64_t index;

    std::string text() const { return fmt::format("{} {}", element, index); }
};

/// The values after the header one by one, whatever the format.
class PlyValues {
public:
    PlyValues(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file.string()), bytes_(bytes), format_(header.format), next_(header.size),
          line_(header.line_count + 1), line_start_(header.size) {}

    /// The next value; integers up to 32 bits are exact as double.
    double next(PlyType type, const PlyItem& what) {
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
    double next_ascii(const PlyItem& what);
    double next_binary(PlyType type, const PlyItem& what);
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

double PlyValues::next_ascii(const PlyItem& what) {
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
        throw_input_error(position(), fmt::format("the file ends before {}", what.text()),
                          "the file is truncated or a count is wrong");
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (failure == std::errc::result_out_of_range)
        return std::numeric_limits<double>::infinity();
    if (failure != std::errc() || stop != token.data() + token.size())
        throw_input_error(position(), fmt::format("{} is \"{}\"", what.text(), token.substr(0, 40)),
                          "write a number");
    return value;
}

double PlyValues::next_binary(PlyType type, const PlyItem& what) {
    const std::size_t size = ply_type_size(type);
    start_ = next_;
    if (remaining() < size)
        throw_input_error({file_},
                          fmt::format("the file ends before {}{}", what.text(), byte_text()),
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

constexpr std::size_t UNUSED = 8;

/// Which of x y z nx ny nz u v each property of a vertex is.
struct VertexColumns {
    std::vector<std::size_t> slot_of_property;
    bool has_normals = false, has_texture = false;
};

VertexColumns vertex_columns(const std::string& file, const PlyElement& element) {
    static const std::vector<std::vector<const char*>> names{{"x"},
                                                             {"y"},
                                                             {"z"},
                                                             {"nx"},
                                                             {"ny"},
                                                             {"nz"},
                                                             {"u", "s", "texture_u"},
                                                             {"v", "t", "texture_v"}};
    VertexColumns columns;
    columns.slot_of_property.assign(element.properties.size(), UNUSED);
    std::array<bool, 8> found{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (element.properties[i].is_list)
            throw_input_error({file, element.line, 1}, "vertices have a list property",
                              "remove it");
        for (std::size_t slot = 0; slot < names.size(); ++slot)
            for (const char* name : names[slot])
                if (element.properties[i].name == name && !found[slot]) {
                    columns.slot_of_property[i] = slot;
                    found[slot] = true;
                }
    }
    if (!found[0] || !found[1] || !found[2])
        throw_input_error({file, element.line, 1}, "vertices have no x, y and z",
                          "declare property float x, y and z");
    columns.has_normals = found[3] && found[4] && found[5];
    columns.has_texture = found[6] && found[7];
    return columns;
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
    float read_coordinate(const PlyProperty& property, const PlyItem& vertex);
    void read_faces(const PlyElement& element);
    void read_corners(const PlyProperty& property, std::uint64_t face);
    void skip(const PlyElement& element);
    std::uint64_t read_list_size(const PlyProperty& property, const PlyItem& what);
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

std::uint64_t PlyReader::read_list_size(const PlyProperty& property, const PlyItem& what) {
    const double size = values_.next(property.count_type, what);
    // In ascii a value takes two bytes, in binary its size; one byte bounds both.
    if (!(size >= 0.0) || size != std::floor(size) ||
        size > static_cast<double>(values_.remaining()))
        fail(fmt::format("the count of {} is {}", what.text(), size),
             fmt::format("it must be a whole number that fits in the {} bytes left",
                         values_.remaining()));
    return static_cast<std::uint64_t>(size);
}

float PlyReader::read_coordinate(const PlyProperty& property, const PlyItem& vertex) {
    const double value = values_.next(property.type, vertex);
    if (std::fabs(value) <= MAX_COORDINATE) // no text is made for a good one
        return static_cast<float>(value);
    return mesh_coordinate(
        value, values_.position(),
        fmt::format("{} of {}{}", property.name, vertex.text(), values_.byte_text()));
}

void PlyReader::read_vertices(const PlyElement& element) {
    const VertexColumns columns = vertex_columns(file_, element);
    vertex_count_ = element.count;
    std::array<float, 8> values{};
    for (std::uint64_t vertex = 0; vertex < element.count; ++vertex) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const std::size_t slot = columns.slot_of_property[i];
            if (slot == UNUSED)
                values_.next(element.properties[i].type, {"vertex", vertex});
            else
                values[slot] = read_coordinate(element.properties[i], {"vertex", vertex});
        }
        mesh_.positions.insert(mesh_.positions.end(), values.begin(), values.begin() + 3);
        if (columns.has_normals)
            mesh_.normals.insert(mesh_.normals.end(), values.begin() + 3, values.begin() + 6);
        if (columns.has_texture)
            mesh_.texture_coordinates.insert(mesh_.texture_coordinates.end(), values.begin() + 6,
                                             values.end());
    }
}

void PlyReader::read_corners(const PlyProperty& property, std::uint64_t face) {
    const std::uint64_t size = read_list_size(property, {"face", face});
    if (size < 3)
        fail(fmt::format("face {} has {} corners", face, size), "a face has at least 3");
    corners_.clear();
    for (std::uint64_t i = 0; i < size; ++i) {
        const double index = values_.next(property.type, {"face", face});
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
                property.is_list ? read_list_size(property, {element.name, i}) : 1;
            for (std::uint64_t k = 0; k < size; ++k)
                values_.next(property.type, {element.name, i});
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
            const PlyItem what{"face", face};
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
