#include "host/study/study/toml_path.h"

#include "host/scene/document/toml_document.h"
#include "host/scene/toml/scene_table.h"
#include "reradiant/paths.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace reradiant {

namespace {

std::optional<std::size_t> as_index(const std::string& part) {
    std::size_t index = 0;
    const char* const end = part.data() + part.size();
    const auto [stop, code] = std::from_chars(part.data(), end, index);
    return code == std::errc{} && stop == end ? std::optional(index) : std::nullopt;
}

std::vector<std::string> parts_within(const toml::node& node) {
    std::vector<std::string> parts;
    if (const toml::table* const table = node.as_table())
        for (const auto& [key, value] : *table)
            parts.emplace_back(key.str());
    else if (const toml::array* const array = node.as_array())
        for (std::size_t i = 0; i < array->size(); ++i)
            parts.push_back(std::to_string(i));
    return parts;
}

const toml::node* child(const toml::node& node, const std::string& part) {
    if (const toml::table* const table = node.as_table())
        return table->get(part);
    if (const toml::array* const array = node.as_array())
        if (const auto index = element_index(*array, part))
            return array->get(*index);
    return nullptr;
}

/// " in material.0.layer" of the first `count` parts.
std::string within(const TomlPath& path, std::size_t count) {
    const auto end = path.begin() + static_cast<std::ptrdiff_t>(count);
    return count == 0 ? "" : fmt::format(" in {}", fmt::join(path.begin(), end, "."));
}

} // namespace

TomlPath toml_path(const std::string& dotted) {
    TomlPath parts;
    for (std::size_t start = 0; start <= dotted.size();) {
        const std::size_t end = std::min(dotted.find('.', start), dotted.size());
        parts.push_back(dotted.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

std::optional<std::size_t> element_index(const toml::array& array, const std::string& part) {
    if (const auto index = as_index(part))
        return *index < array.size() ? index : std::nullopt;
    for (std::size_t i = 0; i < array.size(); ++i)
        if (const toml::table* const table = array[i].as_table())
            if ((*table)["name"].value_or(std::string()) == part)
                return i;
    return std::nullopt;
}

const toml::node& node_at(const toml::table& root, const TomlPath& path, std::size_t count,
                          const SourcePosition& at) {
    const toml::node* node = &root;
    for (std::size_t k = 0; k < count; ++k) {
        const toml::node* const next = child(*node, path[k]);
        if (next == nullptr)
            throw_input_error(at,
                              fmt::format("the scene has no \"{}\"{}", path[k], within(path, k)),
                              fmt::format("there are: {}", fmt::join(parts_within(*node), ", ")));
        node = next;
    }
    return *node;
}

toml::node& node_at(toml::table& root, const TomlPath& path, std::size_t count,
                    const SourcePosition& at) {
    return const_cast<toml::node&>(node_at(std::as_const(root), path, count, at));
}

TomlPath settled_path(const toml::table& root, TomlPath path, const SourcePosition& at) {
    for (std::size_t k = 0; k < path.size(); ++k)
        if (const toml::array* const array = node_at(root, path, k, at).as_array())
            if (const auto index = element_index(*array, path[k]))
                path[k] = std::to_string(*index);
    const toml::node& parent = node_at(root, path, path.size() - 1, at);
    if (parent.is_array())
        node_at(root, path, path.size(), at);
    else if (!parent.is_table())
        throw_input_error(at,
                          fmt::format("there is no \"{}\"{}: that is {}", path.back(),
                                      within(path, path.size() - 1), toml_type_name(parent)),
                          "give the key of a table or an element of an array");
    return path;
}

void write_out_presets(toml::table& scene) {
    toml::array* const materials = scene["material"].as_array();
    const std::vector<std::string> known = preset_names();
    for (std::size_t i = 0; materials != nullptr && i < materials->size(); ++i) {
        const toml::table* const material = (*materials)[i].as_table();
        const std::string preset =
            material != nullptr ? (*material)["preset"].value_or(std::string()) : std::string();
        if (std::find(known.begin(), known.end(), preset) == known.end())
            continue; // none, or one that loading the scene refuses
        const toml::table file =
            read_scene_table(spectra_directory() / "materials" / (preset + ".toml"));
        if (file.contains("texture"))
            continue;
        toml::table written = *file["material"].as_table();
        written.insert_or_assign("name", (*material)["name"].value_or(preset));
        materials->replace(materials->begin() + static_cast<std::ptrdiff_t>(i), std::move(written));
    }
}

} // namespace reradiant
