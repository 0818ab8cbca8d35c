#pragma once

#include <fmt/core.h>

#include <string>
#include <utility>

/// Messages to the user by severity; the log of spdlog takes them, whose own header takes seconds
/// to compile. Arguments are formatted as fmt does.
namespace reradiant::logging {

void write_debug(const std::string& message);
void write_info(const std::string& message);
void write_warning(const std::string& message);
void write_error(const std::string& message);

template <typename... Arguments>
void debug(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    write_debug(fmt::format(format, std::forward<Arguments>(arguments)...));
}
template <typename... Arguments>
void info(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    write_info(fmt::format(format, std::forward<Arguments>(arguments)...));
}
template <typename... Arguments>
void warn(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    write_warning(fmt::format(format, std::forward<Arguments>(arguments)...));
}
template <typename... Arguments>
void error(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    write_error(fmt::format(format, std::forward<Arguments>(arguments)...));
}

} // namespace reradiant::logging
