#pragma once

#include <string>
#include <string_view>

namespace reradiant {

/// A line "key: value", "key = value", "key,value", or "key 0.01".
struct KeyValue {
    enum class Kind { None, XUnits, YUnits, Units, Factor } kind = Kind::None;
    std::string value;
};

/// Returns what a line above a table tells by a key; Kind::None for headings, titles and any other
/// key.
KeyValue key_value_of(std::string_view line);

/// True for a line "unit: percent", "Scale factor 0.01" that tells how values are to be read.
bool tells_units(std::string_view line);

/// True for a remark such as "values in percent", where a word for the values stands beside the
/// unit: "humidity in %" is of something else.
bool says_values_are_percent(std::string_view remark);

} // namespace reradiant
