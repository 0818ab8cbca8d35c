#pragma once

#include <spdlog/spdlog.h>

namespace reradiant {

/// Nothing is warned about while it lives, in any thread: for what is read or written a second time
/// and has been warned about before.
class QuietLog {
public:
    QuietLog() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::err); }
    ~QuietLog() { spdlog::set_level(level_); }
    QuietLog(const QuietLog&) = delete;
    QuietLog& operator=(const QuietLog&) = delete;

private:
    spdlog::level::level_enum level_;
};

} // namespace reradiant
