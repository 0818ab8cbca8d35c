#include "host/cluster/core_share.h"

#include <algorithm>
#include <sched.h>
#include <unistd.h>

namespace reradiant {

int share_of_cores(const Team& team) {
    const int cores = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
    cpu_set_t bound;
    const int allowed =
        ::sched_getaffinity(0, sizeof bound, &bound) == 0 ? CPU_COUNT(&bound) : cores;
    return std::max(1, std::min(allowed, cores / team.size_on_host()));
}

} // namespace reradiant
