#include "host/scene/meshes/obj_text.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Form feeds, and the control-Z with which old systems end a text, stand between words too.
constexpr std::string_view blanks = " \t\f\v\x1a";

} // namespace

void ObjText::take_line() {
    const std::size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
    whole_line_ = line_ = rest_.substr(0, length);
    rest_.remove_prefix(length);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
    ++line_number_;
    line_ = line_.substr(0, line_.find('#'));
    const std::size_t last = line_.find_last_not_of(blanks);
    goes_on_ =
        last != std::string_view::npos && line_[last] == '\\' && line_.size() == whole_line_.size();
    if (goes_on_)
        line_ = line_.substr(0, last);
}

bool ObjText::next_statement() {
    while (goes_on_ && !rest_.empty())
        take_line();
    if (rest_.empty())
        return false;
    take_line();
    return true;
}

std::string_view ObjText::word() {
    std::size_t start = line_.find_first_not_of(blanks);
    while (start == std::string_view::npos && goes_on_ && !rest_.empty()) {
        take_line();
        start = line_.find_first_not_of(blanks);
    }
    if (start == std::string_view::npos) {
        line_ = {};
        column_ = static_cast<int>(whole_line_.size()) + 1;
        return {};
    }
    line_.remove_prefix(start);
    column_ = static_cast<int>(line_.data() - whole_line_.data()) + 1;
    const std::string_view found = line_.substr(0, line_.find_first_of(blanks));
    line_.remove_prefix(found.size());
    return found;
}

} // namespace reradiant
