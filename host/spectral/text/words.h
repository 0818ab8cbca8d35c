#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace reradiant {

// Words of headings and of header lines, in ASCII under any locale.

inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower)
        if (letter >= 'A' && letter <= 'Z')
            letter = static_cast<char>(letter - 'A' + 'a');
    return lower;
}

template <typename Words>
bool is_one_of(const Words& known, std::string_view word) {
    return std::find(known.begin(), known.end(), word) != known.end();
}

} // namespace reradiant
