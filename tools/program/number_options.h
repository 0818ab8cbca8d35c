#pragma once

#include <CLI/CLI.hpp>

namespace reradiant {

/// Checks of options that take a number: CLI11's own take "nan", which no comparison finds too
/// small.
inline CLI::Validator number_check(const char* description, bool (*holds)(double)) {
    return {[description, holds](const std::string& text) {
                double value = 0.0;
                const bool is_number = CLI::detail::lexical_cast(text, value);
                return is_number && holds(value) ? std::string{}
                                                 : "'" + text + "' is not a " + description;
            },
            description};
}
inline CLI::Validator positive_number() {
    return number_check("positive number", [](double value) { return value > 0.0; });
}
inline CLI::Validator non_negative_number() {
    return number_check("number of 0 or more", [](double value) { return value >= 0.0; });
}

} // namespace reradiant
