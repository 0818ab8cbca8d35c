#pragma once

#include <string>
#include <vector>

namespace reradiant {

/// Cuts a text at its spaces into lines that fit a width, in units of the font's size; line breaks
/// within it stay. A word that is wider is cut off and ends in an ellipsis. An empty text has no
/// lines.
std::vector<std::string> wrapped_text(const std::string& text, double width, bool is_bold = false);

} // namespace reradiant
