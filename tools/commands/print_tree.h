#pragma once

#include <nlohmann/json_fwd.hpp>

namespace reradiant {

/// Prints a JSON object for people: one line a value, groups indented, numbers to nine digits.
void print_tree(const nlohmann::ordered_json& tree);

} // namespace reradiant
