#include "host/base/plain_text.h"

#include <algorithm>

namespace reradiant {

namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
constexpr std::string_view control_z = "\x1a";

} // namespace

std::string plain_text(std::string_view bytes) {
    if (bytes.starts_with(byte_order_mark))
        bytes.remove_prefix(byte_order_mark.size());
    // DOS filled the last sector with more of them; one before other text is no end.
    const auto last = bytes.find_last_not_of("\x1a \t\r\n");
    const auto behind = last == std::string_view::npos ? 0 : last + 1;
    bytes = bytes.substr(0, std::min(bytes.find(control_z, behind), bytes.size()));
    std::string text;
    text.reserve(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != '\r')
            text += bytes[i];
        else if (i + 1 >= bytes.size() || bytes[i + 1] != '\n')
            text += '\n';
    return text;
}

} // namespace reradiant
