#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace reradiant::test {

/// An empty folder for the test that runs, removed with it.
class TemporaryFolder {
public:
    explicit TemporaryFolder(const std::string& purpose = "files") {
        const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string name = "reradiant-" + purpose;
        if (test != nullptr)
            name += std::string("-") + test->test_suite_name() + "-" + test->name();
        std::replace(name.begin(), name.end(), '/', '-'); // of parametrised tests
        path_ = std::filesystem::temp_directory_path() / (name + "-" + std::to_string(::getpid()));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    /// Counts files, hidden ones included: nothing may be left over.
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

inline std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// A fixture with a folder of its own for each test.
class ScratchFolder : public ::testing::Test {
protected:
    std::filesystem::path path(const std::string& name) const { return folder / name; }
    /// Writes a file and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        put_bytes(path(name), text);
        return path(name);
    }

    const TemporaryFolder scratch;
    const std::filesystem::path folder = scratch.path();
};

} // namespace reradiant::test
