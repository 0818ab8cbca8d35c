#include "host/scene/meshes/mesh_io.h"

#include "host/base/logging.h"
#include "host/scene/document/table_reader.h"
#include "host/scene/meshes/ply_header.h"
#include "host/scene/meshes/ply_values.h"
#include "host/scene/meshes/ply_wedges.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr std::size_t UNUSED = 8;

/// `VertexColumns` says which of x y z nx ny nz u v each property of a vertex is.
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
                                                             {"u", "s", "texture_u", "texture_s"},
                                                             {"v", "t", "texture_v", "texture_t"}};
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

/// `FaceColumns` says which properties of a face hold what is read; -1 for none.
struct FaceColumns {
    int corners = -1;
    int wedges = -1;  ///< list of u v of every corner
    int texture = -1; ///< number of the image that u and v are in
};

FaceColumns face_columns(const std::string& file, const PlyElement& element) {
    const auto is_list = [&](int column) {
        return column >= 0 && element.properties[static_cast<std::size_t>(column)].is_list;
    };
    FaceColumns columns;
    columns.corners = element.index_of("vertex_indices");
    if (columns.corners < 0)
        columns.corners = element.index_of("vertex_index");
    if (!is_list(columns.corners))
        throw_input_error({file, element.line, 1}, "faces have no list vertex_indices",
                          "declare property list uchar int vertex_indices");
    columns.wedges = element.index_of("texcoord");
    if (!is_list(columns.wedges))
        columns.wedges = -1;
    columns.texture = element.index_of("texnumber");
    if (is_list(columns.texture))
        columns.texture = -1;
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
    void read_face(const PlyElement& element, const FaceColumns& columns, std::uint64_t face);
    void read_corners(const PlyProperty& property, std::uint64_t face);
    void read_wedges(const PlyProperty& property, std::uint64_t face);
    void apply_wedges(std::uint64_t face);
    void note_texture(double number);
    void add_face(std::uint64_t face);
    void skip_property(const PlyProperty& property, const PlyItem& what);
    void warn_of_rest();
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
    std::vector<Vector3> positions_;  ///< of the corners
    std::vector<float> wedge_values_; ///< u v of the corners
    std::optional<double> texture_number_;
    bool warned_of_textures_ = false;
    MeshShape mesh_;
    std::optional<WedgeVertices> wedges_; ///< set when faces have texture coordinates
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
}

void PlyReader::read_wedges(const PlyProperty& property, std::uint64_t face) {
    const PlyItem what{"face", face};
    const std::uint64_t size = read_list_size(property, what);
    wedge_values_.clear();
    for (std::uint64_t i = 0; i < size; ++i)
        wedge_values_.push_back(read_coordinate(property, what));
}

/// Faces without texture coordinates have none of theirs: (0, 0), as corners of an OBJ file.
void PlyReader::apply_wedges(std::uint64_t face) {
    if (wedge_values_.empty())
        wedge_values_.assign(2 * corners_.size(), 0.0f);
    if (wedge_values_.size() != 2 * corners_.size())
        fail(fmt::format("face {} has {} corners and {} numbers in texcoord", face, corners_.size(),
                         wedge_values_.size()),
             "write u and v of every corner, or none");
    for (std::size_t i = 0; i < corners_.size(); ++i)
        corners_[i] =
            wedges_->with_texture(corners_[i], wedge_values_[2 * i], wedge_values_[2 * i + 1]);
}

void PlyReader::note_texture(double number) {
    if (texture_number_ && *texture_number_ != number && !warned_of_textures_) {
        logging::warn(
            "{}: the faces lie in several images (texnumber); one texture is used for all "
            "of them",
            file_);
        warned_of_textures_ = true;
    }
    texture_number_ = number;
}

void PlyReader::add_face(std::uint64_t face) {
    positions_.clear();
    for (const std::uint32_t corner : corners_) {
        const float* const p = &mesh_.positions[3 * std::size_t{corner}];
        positions_.push_back({p[0], p[1], p[2]});
    }
    if (wedges_)
        apply_wedges(face);
    append_face(corners_, positions_, face, values_.position(), mesh_);
}

void PlyReader::skip_property(const PlyProperty& property, const PlyItem& what) {
    const std::uint64_t size = property.is_list ? read_list_size(property, what) : 1;
    for (std::uint64_t k = 0; k < size; ++k)
        values_.next(property.type, what);
}

void PlyReader::skip(const PlyElement& element) {
    if (element.properties.empty())
        return;
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties)
            skip_property(property, {element.name, i});
}

void PlyReader::read_face(const PlyElement& element, const FaceColumns& columns,
                          std::uint64_t face) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int column = static_cast<int>(i);
        if (column == columns.corners)
            read_corners(property, face);
        else if (column == columns.wedges)
            read_wedges(property, face);
        else if (column == columns.texture)
            note_texture(values_.next(property.type, {"face", face}));
        else
            skip_property(property, {"face", face});
    }
    add_face(face);
}

void PlyReader::read_faces(const PlyElement& element) {
    const FaceColumns columns = face_columns(file_, element);
    if (columns.wedges >= 0)
        wedges_.emplace(mesh_);
    for (std::uint64_t face = 0; face < element.count; ++face)
        read_face(element, columns, face);
}

/// A count in the header that is too small would leave faces out without a word.
void PlyReader::warn_of_rest() {
    if (values_.has_more())
        logging::warn("{}: more follows after the last element{}; it is left out",
                      values_.position().text(), values_.byte_text());
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
        } else if (element.name == "tristrips") {
            throw_input_error({file_, element.line, 1}, "triangle strips are not read",
                              "write the triangles as faces");
        } else {
            skip(element);
        }
    }
    warn_of_rest();
    return std::move(mesh_);
}

} // namespace

MeshShape parse_ply(const std::filesystem::path& file, std::string_view bytes) {
    return PlyReader(file, bytes).read();
}

} // namespace reradiant
