#pragma once

#include <nlohmann/json.hpp>

#include <concepts>
#include <cstdint>
#include <string>
#include <utility>

namespace reradiant {

/// A whole number that fits the type; Json::type_error for anything else, which `get` would cut to
/// fit.
template <std::integral Integer, typename Json>
Integer whole_number(const Json& json) {
    if (json.is_number_unsigned()) {
        const auto value = json.template get<std::uint64_t>();
        if (std::in_range<Integer>(value))
            return static_cast<Integer>(value);
    } else if (json.is_number_integer()) {
        const auto value = json.template get<std::int64_t>();
        if (std::in_range<Integer>(value))
            return static_cast<Integer>(value);
    }
    throw Json::type_error::create(
        302, std::string("a whole number must be here, not ") + json.type_name(), &json);
}

} // namespace reradiant
