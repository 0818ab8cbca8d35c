#include "host/scene/mesh_io.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

namespace reradiant {

namespace {

/// What a corner of a face refers to, counted from 0; ABSENT when not given.
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

/// Reads one OBJ text line by line.
class ObjReader {
public:
    ObjReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file.string()), rest_(bytes) {}

    MeshShape read();

private:
    void read_line();
    void read_numbers(std::vector<double>& values, int count, const std::string& name);
    void read_face();
    Corner read_corner(std::string_view token);
    std::uint32_t read_index(std::string_view text, std::size_t count, const char* name) const;
    std::uint32_t vertex_of(const Corner& corner);
    void add_normal(MeshShape& mesh, std::uint32_t normal) const;
    void add_texture(MeshShape& mesh, std::uint32_t texture) const;
    std::string_view token();
    [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const {
        throw_input_error({file_, line_number_, column_}, wrong, remedy);
    }

    std::string file_;
    std::string_view rest_, line_, whole_line_;
    int line_number_ = 0, column_ = 1;
    std::size_t face_count_ = 0;
    std::vector<double> positions_, textures_, normals_;
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
    std::vector<Corner> corners_; ///< of each vertex of the mesh
    std::vector<std::uint32_t> face_;
    MeshShape mesh_;
};

std::string_view ObjReader::token() {
    const std::size_t start = line_.find_first_not_of(" \t\r");
    if (start == std::string_view::npos || line_[start] == '#') {
        line_ = {};
        column_ = static_cast<int>(whole_line_.size()) + 1;
        return {};
    }
    line_.remove_prefix(start);
    column_ = static_cast<int>(line_.data() - whole_line_.data()) + 1;
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t\r"));
    line_.remove_prefix(found.size());
    return found;
}

void ObjReader::read_numbers(std::vector<double>& values, int count, const std::string& name) {
    for (int i = 0; i < count; ++i) {
        const std::string_view text = token();
        double value = 0.0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::string which = fmt::format("{} {} of {}", "coordinate", i + 1, name);
        if (failure == std::errc::result_out_of_range)
            value = std::numeric_limits<double>::infinity();
        else if (failure != std::errc() || end != text.data() + text.size())
            fail(fmt::format("{} is \"{}\"", which, text.substr(0, 40)), "write a number");
        values.push_back(mesh_coordinate(value, {file_, line_number_, column_}, which));
    }
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
    const std::string_view after = text.substr(first + 1);
    const std::size_t second = after.find('/');
    if (const auto texture = after.substr(0, second); !texture.empty())
        corner.texture = read_index(texture, textures_.size() / 2, "texture coordinate");
    if (second != std::string_view::npos)
        corner.normal = read_index(after.substr(second + 1), normals_.size() / 3, "normal");
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
    for (auto text = token(); !text.empty(); text = token())
        face_.push_back(vertex_of(read_corner(text)));
    if (face_.size() < 3)
        fail(fmt::format("face {} has {} corners", face_count_ + 1, face_.size()),
             "a face has at least 3");
    append_fan(face_, mesh_);
    ++face_count_;
}

void ObjReader::read_line() {
    const std::string_view keyword = token();
    if (keyword == "v")
        read_numbers(positions_, 3, fmt::format("vertex {}", positions_.size() / 3 + 1));
    else if (keyword == "vn")
        read_numbers(normals_, 3, fmt::format("normal {}", normals_.size() / 3 + 1));
    else if (keyword == "vt")
        read_numbers(textures_, 2, fmt::format("texture coordinate {}", textures_.size() / 2 + 1));
    else if (keyword == "f")
        read_face();
}

void ObjReader::add_normal(MeshShape& mesh, std::uint32_t normal) const {
    // A corner without a normal gets zero, which means: shade with the triangle's own.
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
    while (!rest_.empty()) {
        const std::size_t length = std::min(rest_.find('\n'), rest_.size());
        whole_line_ = line_ = rest_.substr(0, length);
        rest_.remove_prefix(std::min(length + 1, rest_.size()));
        ++line_number_;
        read_line();
    }
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
