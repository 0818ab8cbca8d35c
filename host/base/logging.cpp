#include "host/base/logging.h"

#include <spdlog/spdlog.h>

namespace reradiant::logging {

void write_debug(const std::string& message) {
    spdlog::debug("{}", message);
}

void write_info(const std::string& message) {
    spdlog::info("{}", message);
}

void write_warning(const std::string& message) {
    spdlog::warn("{}", message);
}

void write_error(const std::string& message) {
    spdlog::error("{}", message);
}

} // namespace reradiant::logging
