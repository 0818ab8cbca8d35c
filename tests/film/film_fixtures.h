#pragma once

#include "reradiant/error.h"
#include "reradiant/spectral_image.h"
#include "tests/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

namespace reradiant {

using test::file_bytes;
using test::put_bytes;
using test::TemporaryFolder;

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
