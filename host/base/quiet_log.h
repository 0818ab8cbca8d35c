#pragma once

namespace reradiant {

/// Nothing is warned about while it lives, in any thread: for what is read or written a second time
/// and has been warned about before.
class QuietLog {
public:
    QuietLog();
    ~QuietLog();
    QuietLog(const QuietLog&) = delete;
    QuietLog& operator=(const QuietLog&) = delete;

private:
    int level_; ///< of spdlog
};

} // namespace reradiant
