#pragma once

#include "reradiant/error.h"

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A `TomlPath` says where something stands in tables, part by part: keys of tables, and for arrays
/// an index or the `name` of the element.
using TomlPath = std::vector<std::string>;

/// Splits a path as it is written, such as "material.sample.layer.0.thickness".
TomlPath toml_path(const std::string& dotted);

/// Index of the element that a part means; nothing when there is none.
std::optional<std::size_t> element_index(const toml::array& array, const std::string& part);

/// The node that the first `count` parts lead to. Input Error at `at` that says what there is when
/// one of them leads nowhere.
toml::node& node_at(toml::table& root, const TomlPath& path, std::size_t count,
                    const SourcePosition& at);
const toml::node& node_at(const toml::table& root, const TomlPath& path, std::size_t count,
                          const SourcePosition& at);

/// The path with names of elements written as their indices, so that two spellings of one place are
/// equal. All but the last part must lead somewhere; the last may be a key that is not yet there,
/// but no element of an array that is not there.
TomlPath settled_path(const toml::table& root, TomlPath path, const SourcePosition& at);

/// Writes [[material]]s that are presets out, so that their parts can be changed. Presets with
/// textures of their own stay as they are.
void write_out_presets(toml::table& scene);

} // namespace reradiant
