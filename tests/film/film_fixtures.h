#pragma once

#include "reradiant/error.h"
#include "reradiant/spectral_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <unistd.h>

namespace reradiant {

/// An empty folder for one test, removed with it.
class TemporaryFolder {
public:
    explicit TemporaryFolder(const std::string& purpose = "files") {
        const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::temp_directory_path() /
                ("reradiant-" + std::string(test->test_suite_name()) + "-" + test->name() + "-" +
                 purpose + "-" + std::to_string(::getpid()));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    /// Count of files, hidden ones included: nothing may be left over.
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), {}));
    }

private:
    std::filesystem::path path_;
};

/// Every value different and some of them hard: tiny, huge, negative, zero.
inline SpectralImage patterned_image(int width, int height, const WavelengthGrid& bands) {
    SpectralImage image;
    image.width = width;
    image.height = height;
    image.bands = bands;
    const auto entries = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                         static_cast<std::size_t>(bands.count);
    for (std::size_t i = 0; i < entries; ++i)
        image.values.push_back(std::sin(static_cast<float>(i)) + 1.5f);
    const float hard[] = {0.0f, 2e-8f, 1e-30f, 65520.0f, 3e38f, -1e-3f};
    for (std::size_t i = 0; i < std::min(entries, std::size(hard)); ++i)
        image.values[i] = hard[i];
    return image;
}

/// Returns an image with `value` as the radiance of every pixel and band.
inline SpectralImage flat_image(int width, int height, const WavelengthGrid& bands, float value) {
    SpectralImage image = patterned_image(width, height, bands);
    std::fill(image.values.begin(), image.values.end(), value);
    return image;
}

inline std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Runs `action` and returns the message of the Error it must throw, which must have this exit
/// code.
inline std::string error_message(int exit_code, const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), exit_code) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no Error was thrown";
    return {};
}

} // namespace reradiant
