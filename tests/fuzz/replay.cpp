#include "tests/fuzz/fuzz_input.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <sys/resource.h>
#include <vector>

// Without libFuzzer: runs a target over its corpus, over every truncation of every file of it, and
// over seeded random mutations. A crash ends the program, and so does a run that takes more than a
// second or memory beyond the limit.

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A second is the contract; a machine that compiles beside the test gets three times that, and
/// sanitizers take about five times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double most_seconds = 15.0;
constexpr bool sanitized = true;
#else
constexpr double most_seconds = 3.0;
constexpr bool sanitized = false;
#endif
/// Far above what the small files of a corpus need, far below what a hostile count would take.
constexpr rlim_t most_bytes = rlim_t{1} << 30;

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> read_corpus(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end()); // the same mutations on every machine
    std::vector<std::string> corpus;
    for (const fs::path& file : files)
        corpus.push_back(content(file));
    return corpus;
}

class Replay {
public:
    void run(const std::string& bytes) {
        const auto start = Clock::now();
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        ++executions_;
        slowest_ = std::max(slowest_, seconds);
        if (seconds <= most_seconds)
            return;
        const fs::path kept = fs::temp_directory_path() / "reradiant-slow-input";
        std::ofstream(kept, std::ios::binary) << bytes;
        reradiant::fuzz::fail(kept.string() + " took " + std::to_string(seconds) + " s");
    }

    void run_truncations(const std::string& bytes) {
        for (std::size_t size = 0; size < bytes.size(); ++size)
            run(bytes.substr(0, size));
    }

    void run_mutations(const std::vector<std::string>& corpus, int count) {
        for (int i = 0; i < count; ++i)
            run(mutated(corpus));
    }

    void report() const {
        std::printf("%d executions, the slowest took %.3f s\n", executions_, slowest_);
    }

private:
    std::size_t below(std::size_t end) { return std::size_t{random_()} % end; }

    /// One to four changes: a byte, a piece taken out, a piece from another file put in.
    std::string mutated(const std::vector<std::string>& corpus) {
        std::string bytes = corpus[below(corpus.size())];
        for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
            const std::size_t at = below(bytes.size());
            const std::size_t kind = below(4);
            if (kind <= 1)
                bytes[at] = static_cast<char>(below(256));
            else if (kind == 2)
                bytes.erase(at, 1 + below(16));
            else if (const std::string& other = corpus[below(corpus.size())]; !other.empty())
                bytes.insert(at, other, below(other.size()), 1 + below(64));
        }
        return bytes;
    }

    std::mt19937 random_{20261128};
    int executions_ = 0;
    double slowest_ = 0.0;
};

} // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: %s CORPUS [MUTATIONS]\n", arguments[0]);
        return 2;
    }
    if (!sanitized) { // those reserve terabytes of addresses
        const rlimit limit{most_bytes, most_bytes};
        ::setrlimit(RLIMIT_AS, &limit);
    }
    const std::vector<std::string> corpus = read_corpus(arguments[1]);
    if (corpus.empty()) {
        std::fprintf(stderr, "%s holds no files\n", arguments[1]);
        return 2;
    }
    Replay replay;
    for (const std::string& bytes : corpus)
        replay.run(bytes);
    for (const std::string& bytes : corpus)
        replay.run_truncations(bytes);
    replay.run_mutations(corpus, count > 2 ? std::atoi(arguments[2]) : 1000);
    replay.report();
    return 0;
}
