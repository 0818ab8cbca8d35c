#pragma once

#include "reradiant/error.h"

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace reradiant {

/// Parses TOML text. `file` is the name that errors show. Syntax errors and nesting beyond what
/// the parser can take on its stack become input Errors with line and column.
toml::table parse_toml(const std::string& file, std::string_view text);

/// Puts the keys of one table over those of another: tables are joined key by key, arrays of tables
/// element by element, and any other value takes the place of what was there. Keys keep their place
/// and file.
void lay_over(const toml::table& above, toml::table& below);

/// Returns the place where a region of source (a key or a node) starts: in its own file, or in
/// `file` where it does not say which.
SourcePosition position_of(const std::string& file, const toml::source_region& region);
/// Returns the place where a node starts. A node that was made rather than read has no place of its
/// own, but its keys may have one (place_keys): then this is the place of the first of these, or
/// `otherwise`.
SourcePosition position_of(const std::string& file, const toml::node& node,
                           const SourcePosition& otherwise = {});

/// Gives a place in a file to every key of a table, and of the tables within it, that has none:
/// errors about the table then point at what it was made from.
void place_keys(toml::table& table, const SourcePosition& position);
toml::key placed_key(const std::string& key, const SourcePosition& position);

/// Returns the type as messages name it: "a string", "a table", ...
const char* toml_type_name(const toml::node& node);

} // namespace reradiant
