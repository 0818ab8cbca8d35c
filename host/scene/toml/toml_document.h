#pragma once

#include "reradiant/error.h"

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace reradiant {

/// Parses TOML text. `file` is the name that errors show. Syntax errors and nesting beyond what
/// the parser can take on its stack become input Errors with line and column.
toml::table parse_toml(const std::string& file, std::string_view text);

/// Where a key or a node starts.
SourcePosition position_of(const std::string& file, const toml::source_region& region);
/// The same of a node. One that was made rather than read has no place of its own, but its keys
/// may have (place_keys): then the first of these, or `otherwise`.
SourcePosition position_of(const std::string& file, const toml::node& node,
                           const SourcePosition& otherwise = {});

/// Gives a place in a file to every key of a table that has none, also of tables within it: errors
/// about the table are then placed in what it was made from.
void place_keys(toml::table& table, const SourcePosition& position);
toml::key placed_key(const std::string& key, const SourcePosition& position);

/// "a string", "a table", ... for messages.
const char* toml_type_name(const toml::node& node);

} // namespace reradiant
