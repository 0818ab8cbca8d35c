#pragma once

#include <string>

namespace reradiant {

/// Returns the keys of scene and material files as Markdown, from what the loader itself asks of
/// files that hold every key once. Throws std::logic_error when a key or a type was not met, or has
/// no explanation: the reference is complete or not there.
std::string format_reference();

/// Returns the explanation of a key by its table and name; empty when nothing is written about it.
std::string reference_text(const std::string& table, const std::string& key);

} // namespace reradiant
