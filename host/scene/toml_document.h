#pragma once

#include "host/error.h"

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace reradiant {

/// Parses TOML text. `file` is the name that errors show. Syntax errors and nesting beyond what
/// the parser can take on its stack become input Errors with line and column.
toml::table parse_toml(const std::string& file, std::string_view text);

/// Where a node starts.
SourcePosition position_of(const std::string& file, const toml::source_region& region);

/// "a string", "a table", ... for messages.
const char* toml_type_name(const toml::node& node);

} // namespace reradiant
