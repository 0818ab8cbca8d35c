#include "host/fit/models/run_in_parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace reradiant {

void run_in_parallel(int threads, std::size_t count, const std::function<void(std::size_t)>& work) {
    // TBB complains of arenas that are larger than the machine.
    const int most = tbb::this_task_arena::max_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, most) : most);
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const auto& range) {
                for (std::size_t k = range.begin(); k < range.end(); ++k)
                    work(k);
            },
            tbb::simple_partitioner());
    });
}

} // namespace reradiant
