#include "host/base/memory_limit.h"

#include <fmt/core.h>

#include <unistd.h>

namespace reradiant {

std::uint64_t machine_memory_bytes() {
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
}

void check_memory_limit(const SourcePosition& position, const std::string& work, double bytes,
                        std::uint64_t limit_bytes, const std::string& remedy) {
    const std::uint64_t limit = limit_bytes > 0 ? limit_bytes : machine_memory_bytes() / 5 * 4;
    if (bytes > static_cast<double>(limit))
        throw_input_error(position,
                          fmt::format("{} would take {:.0f} bytes of memory, the limit is {}", work,
                                      bytes, limit),
                          remedy + " or raise --memory-limit");
}

} // namespace reradiant
