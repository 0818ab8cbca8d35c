#include "host/base/quiet_log.h"

#include <spdlog/spdlog.h>

namespace reradiant {

QuietLog::QuietLog() : level_(static_cast<int>(spdlog::get_level())) {
    spdlog::set_level(spdlog::level::err);
}

QuietLog::~QuietLog() {
    spdlog::set_level(static_cast<spdlog::level::level_enum>(level_));
}

} // namespace reradiant
