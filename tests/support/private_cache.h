#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace reradiant::test {

/// Points the cache to a folder of this process's own for as long as it lives: tests neither see
/// nor leave the user's files.
class PrivateCache {
public:
    explicit PrivateCache(const std::string& name)
        : folder_(std::filesystem::temp_directory_path() /
                  ("reradiant-" + name + "-" + std::to_string(getpid()))) {
        setenv("RERADIANT_CACHE", folder_.c_str(), 1);
    }
    ~PrivateCache() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    PrivateCache(const PrivateCache&) = delete;
    PrivateCache& operator=(const PrivateCache&) = delete;

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

} // namespace reradiant::test
