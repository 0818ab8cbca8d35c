#include "tests/tables/built_kernels.h"

#include "reradiant/error.h"
#include "tests/render/kernel_sizes.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <sys/wait.h>
#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// An empty cache for programs and what the driver makes of them.
class EmptyCache {
public:
    EmptyCache()
        : folder_(fs::temp_directory_path() / fmt::format("reradiant-built-anew-{}", ::getpid())) {
        fs::create_directories(compiled());
        ::setenv("RERADIANT_CACHE", folder_.c_str(), 1);
        ::setenv("POCL_CACHE_DIR", compiled().c_str(), 1);
    }
    ~EmptyCache() { fs::remove_all(folder_); }
    fs::path compiled() const { return folder_ / "compiled"; }
    EmptyCache(const EmptyCache&) = delete;
    EmptyCache& operator=(const EmptyCache&) = delete;

private:
    fs::path folder_;
};

BuiltKernels built_here(const Scene& scene, const RenderOptions& options) {
    const EmptyCache cache;
    prepare_opencl(0);
    const RenderResult result = render(scene, Device(""), options);
    return {result.build.seconds, preprocessed_bytes(RERADIANT_SOURCE_DIR, result.build.defines),
            instruction_count(cache.compiled()), result.device_bytes};
}

[[noreturn]] void report_and_exit(int pipe, const Scene& scene, const RenderOptions& options) {
    bool written = false;
    try {
        const BuiltKernels built = built_here(scene, options);
        written = ::write(pipe, &built, sizeof built) == static_cast<ssize_t>(sizeof built);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
    }
    std::fflush(stderr);
    ::_exit(written ? 0 : 1);
}

} // namespace

BuiltKernels kernels_built_anew(const Scene& scene, const RenderOptions& options) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0)
        throw_runtime_error("no pipe to a child process");
    const pid_t child = ::fork();
    if (child == 0)
        report_and_exit(ends[1], scene, options);
    ::close(ends[1]);
    BuiltKernels built;
    const bool read = ::read(ends[0], &built, sizeof built) == static_cast<ssize_t>(sizeof built);
    ::close(ends[0]);
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) < 0 || status != 0 || !read)
        throw_runtime_error("a child process that was to render failed");
    return built;
}

} // namespace reradiant
