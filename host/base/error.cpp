#include "reradiant/error.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

std::string message(const SourcePosition& position, const std::string& what_is_wrong,
                    const std::string& remedy) {
    const std::string place = position.text();
    return fmt::format("{}{}{}{}{}", place, place.empty() ? "" : ": ", what_is_wrong,
                       remedy.empty() ? "" : "; ", remedy);
}

} // namespace

std::string SourcePosition::text() const {
    if (line <= 0)
        return file;
    if (column <= 0)
        return fmt::format("{}:{}", file, line);
    return fmt::format("{}:{}:{}", file, line, column);
}

Error::Error(Kind kind, const SourcePosition& position, const std::string& what_is_wrong,
             const std::string& remedy)
    : std::runtime_error(message(position, what_is_wrong, remedy)), kind_(kind),
      position_(position) {}

void throw_input_error(const SourcePosition& position, const std::string& what_is_wrong,
                       const std::string& remedy) {
    throw Error(Error::Kind::Input, position, what_is_wrong, remedy);
}

void throw_runtime_error(const std::string& what_is_wrong, const std::string& remedy) {
    throw Error(Error::Kind::Runtime, {}, what_is_wrong, remedy);
}

} // namespace reradiant
