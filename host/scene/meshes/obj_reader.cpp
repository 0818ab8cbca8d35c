#include "host/scene/meshes/mesh_io.h"

#include "host/base/logging.h"
#include "host/scene/meshes/obj_text.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>

#include <fmt/core.h>

namespace reradiant {

namespace {

/// A `Corner` holds the indices, counted from 0, that a corner of a face refers to; ABSENT when not
/// given.
struct Corner {
    std::uint32_t position, texture, normal;
    bool operator==(const Corner&) const = default;
};
constexpr std::uint32_t ABSENT = 0xffffffffu;

struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::uint64_t h = c.position;
        h = (h ^ h >> 31) * 0x9e3779b97f4a7c15ull + c.texture;
        h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9ull + c.normal;
        return static_cast<std::size_t>(h ^ h >> 32);
    }
};

/// Statements that say nothing about polygons: names, looks, points, lines and curves.
constexpr std::string_view left_out[] = {
    "o",     "g",     "s",        "mg",       "usemtl", "mtllib", "usemap",     "maplib",
    "lod",   "bevel", "c_interp", "d_interp", "ctech",  "stech",  "shadow_obj", "trace_obj",
    "p",     "l",     "vp",       "cstype",   "deg",    "bmat",   "step",       "curv",
    "curv2", "con",   "parm",     "trim",     "hole",   "scrv",   "sp",         "end"};
/// Statements that stand for surfaces; without them the mesh would have holes.
constexpr std::string_view surfaces[] = {"surf", "bzp", "bsp", "cdc", "call", "csh"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Reads one OBJ text statement by statement.
class ObjReader {
public:
    ObjReader(const std::filesystem::path& file, std::string_view bytes) : text_(file, bytes) {}

    MeshShape read();

private:
    void read_statement();
    void read_other(std::string_view keyword);
    double read_number(std::string_view word, int number, const std::string& name);
    void read_numbers(std::vector<double>& values, int count, const std::string& name);
    void read_vertex();
    void read_texture();
    void read_face();
    Corner read_corner(std::string_view token);
    std::uint32_t read_index(std::string_view text, std::size_t count, const char* name) const;
    std::uint32_t vertex_of(const Corner& corner);
    void add_normal(MeshShape& mesh, std::uint32_t normal) const;
    void add_texture(MeshShape& mesh, std::uint32_t texture) const;
    [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const {
        throw_input_error(text_.position(), wrong, remedy);
    }

    ObjText text_;
    std::size_t face_count_ = 0;
    bool warned_ = false;
    std::vector<double> positions_, textures_, normals_;
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
    std::vector<Corner> corners_; ///< by vertex of the mesh
    std::vector<std::uint32_t> face_;
    std::vector<Vector3> face_positions_;
    MeshShape mesh_;
};

double ObjReader::read_number(std::string_view word, int number, const std::string& name) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1); // from_chars takes no leading plus
    double value = 0.0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    const std::string which = fmt::format("coordinate {} of {}", number, name);
    if (failure == std::errc::result_out_of_range)
        value = std::numeric_limits<double>::infinity();
    else if (failure != std::errc() || end != word.data() + word.size())
        fail(fmt::format("{} is \"{}\"", which, word.substr(0, 40)), "write a number");
    return mesh_coordinate(value, text_.position(), which);
}

void ObjReader::read_numbers(std::vector<double>& values, int count, const std::string& name) {
    for (int i = 0; i < count; ++i)
        values.push_back(read_number(text_.word(), i + 1, name));
}

/// Reads x y z, which a weight and a colour may follow.
void ObjReader::read_vertex() {
    const std::string name = fmt::format("vertex {}", positions_.size() / 3 + 1);
    read_numbers(positions_, 3, name);
    int number = 4;
    for (auto word = text_.word(); !word.empty(); word = text_.word())
        read_number(word, number++, name);
}

/// u alone stands on a line: its v is 0. A third coordinate is for textures with a depth.
void ObjReader::read_texture() {
    const std::string name = fmt::format("texture coordinate {}", textures_.size() / 2 + 1);
    read_numbers(textures_, 1, name);
    const auto word = text_.word();
    textures_.push_back(word.empty() ? 0.0 : read_number(word, 2, name));
}

std::uint32_t ObjReader::read_index(std::string_view text, std::size_t count,
                                    const char* name) const {
    std::int64_t index = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (failure != std::errc() || end != text.data() + text.size())
        fail(fmt::format("face {}: \"{}\" is no {} number", face_count_ + 1, text.substr(0, 40),
                         name),
             "write v, v/vt, v//vn or v/vt/vn");
    const auto size = static_cast<std::int64_t>(count);
    if (index == 0 || index > size || index < -size)
        fail(fmt::format("face {} refers to {} {} of {}", face_count_ + 1, name, index, size),
             "numbers count from 1, or from -1 backwards");
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index);
}

Corner ObjReader::read_corner(std::string_view text) {
    const std::size_t first = text.find('/');
    Corner corner{read_index(text.substr(0, first), positions_.size() / 3, "vertex"), ABSENT,
                  ABSENT};
    if (first == std::string_view::npos)
        return corner;
    // Programs write what is absent as nothing or as 0.
    const auto is_absent = [](std::string_view index) { return index.empty() || index == "0"; };
    const std::string_view after = text.substr(first + 1);
    const std::size_t second = after.find('/');
    if (const auto texture = after.substr(0, second); !is_absent(texture))
        corner.texture = read_index(texture, textures_.size() / 2, "texture coordinate");
    if (second == std::string_view::npos)
        return corner;
    if (const auto normal = after.substr(second + 1); !is_absent(normal))
        corner.normal = read_index(normal, normals_.size() / 3, "normal");
    return corner;
}

std::uint32_t ObjReader::vertex_of(const Corner& corner) {
    const auto [entry, is_new] =
        vertices_.try_emplace(corner, static_cast<std::uint32_t>(corners_.size()));
    if (is_new)
        corners_.push_back(corner);
    return entry->second;
}

void ObjReader::read_face() {
    face_.clear();
    face_positions_.clear();
    for (auto word = text_.word(); !word.empty(); word = text_.word()) {
        const Corner corner = read_corner(word);
        const double* const position = &positions_[3 * std::size_t{corner.position}];
        face_.push_back(vertex_of(corner));
        face_positions_.push_back({position[0], position[1], position[2]});
    }
    ++face_count_;
    if (face_.size() < 3)
        fail(fmt::format("face {} has {} corners", face_count_, face_.size()),
             "a face has at least 3");
    append_face(face_, face_positions_, face_count_, text_.position(), mesh_);
}

void ObjReader::read_other(std::string_view keyword) {
    if (is_one_of(keyword, surfaces))
        fail(fmt::format("\"{}\" stands for a surface that is not read", keyword),
             "write the surface as polygons");
    if (warned_ || is_one_of(keyword, left_out))
        return;
    warned_ = true;
    logging::warn("{}: \"{}\" is no statement of an OBJ file; it is left out, as others like it",
                  text_.position().text(), keyword.substr(0, 40));
}

void ObjReader::read_statement() {
    const std::string_view keyword = text_.word();
    if (keyword == "v")
        read_vertex();
    else if (keyword == "vn")
        read_numbers(normals_, 3, fmt::format("normal {}", normals_.size() / 3 + 1));
    else if (keyword == "vt")
        read_texture();
    else if (keyword == "f" || keyword == "fo")
        read_face();
    else if (!keyword.empty())
        read_other(keyword);
}

void ObjReader::add_normal(MeshShape& mesh, std::uint32_t normal) const {
    // A corner without a normal gets zero, which means that the normal of the triangle is used for
    // shading.
    for (std::size_t axis = 0; axis < 3; ++axis)
        mesh.normals.push_back(
            normal == ABSENT ? 0.0f : static_cast<float>(normals_[3 * std::size_t{normal} + axis]));
}

void ObjReader::add_texture(MeshShape& mesh, std::uint32_t texture) const {
    for (std::size_t axis = 0; axis < 2; ++axis)
        mesh.texture_coordinates.push_back(
            texture == ABSENT ? 0.0f
                              : static_cast<float>(textures_[2 * std::size_t{texture} + axis]));
}

MeshShape ObjReader::read() {
    while (text_.next_statement())
        read_statement();
    bool any_normal = false, any_texture = false;
    for (const Corner& corner : corners_) {
        any_normal = any_normal || corner.normal != ABSENT;
        any_texture = any_texture || corner.texture != ABSENT;
    }
    for (const Corner& corner : corners_) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            mesh_.positions.push_back(
                static_cast<float>(positions_[3 * std::size_t{corner.position} + axis]));
        if (any_normal)
            add_normal(mesh_, corner.normal);
        if (any_texture)
            add_texture(mesh_, corner.texture);
    }
    return std::move(mesh_);
}

} // namespace

MeshShape parse_obj(const std::filesystem::path& file, std::string_view bytes) {
    return ObjReader(file, bytes).read();
}

} // namespace reradiant
