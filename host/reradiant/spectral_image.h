#pragma once

#include "reradiant/wavelength_grid.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// A spectral image: float (height, width, band), radiance per nm.
struct SpectralImage {
    int width = 0, height = 0;
    int left = 0, top = 0; ///< place of the first pixel in its film, if a file gives it
    WavelengthGrid bands;
    std::vector<float> values;
    std::vector<float> sample_count; ///< (height, width) or empty
    std::vector<float> variance_y;   ///< variance of each pixel's mean Y, (height, width) or empty
    std::vector<float> variance_bands; ///< variance of each pixel's and band's mean, or empty
    std::map<std::string, std::string> attributes; ///< reradiant:* text attributes

    float& at(int x, int y, int band) {
        return values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x)) *
                          static_cast<std::size_t>(bands.count) +
                      static_cast<std::size_t>(band)];
    }
    float at(int x, int y, int band) const {
        return const_cast<SpectralImage*>(this)->at(x, y, band);
    }
};

/// Spectral EXR in the layout of Fichet, Pacanowski and Wilkie (JCGT 2021), see
/// tools/docs/scene-files.md "Images". Atomic. Throws an Error that names the file.
void write_spectral_exr(const std::filesystem::path& file, const SpectralImage& image,
                        double exposure_ev = 0.0);
/// Reads a spectral EXR. The image is the display window, black outside the data window. S0
/// channels may be FLOAT or HALF, of wavelengths or frequencies; they must ascend in equal steps.
/// Every row is read; throws an input Error for a truncated file or missing channels.
SpectralImage read_spectral_exr(const std::filesystem::path& file);

struct DisplayOptions {
    std::filesystem::path ocio_config; ///< empty: $OCIO, else the built-in sRGB transform
    std::string display, view;
    double exposure_ev = 0.0;
};
/// 8 bit PNG through OpenColorIO. Returns how many pixels were out of the display's gamut.
std::size_t write_display_png(const std::filesystem::path& file, const SpectralImage& image,
                              const DisplayOptions& options);

/// Linear sRGB (height, width, 3) of an image, from XYZ of unit luminance for unit radiance, not
/// clamped.
std::vector<float> linear_srgb(const SpectralImage& image);

struct Comparison {
    double relmse = 0.0;      ///< mean of d^2 / (ref^2 + 0.01 mean(ref)^2) over bands and pixels
    double relmse_srgb = 0.0; ///< mean of d^2 / (ref^2 + 0.01) over linear sRGB
    double rmse = 0.0;
    double bias = 0.0, bias_stderr = 0.0; ///< mean error over pixels and bands
    double ciede2000 = 0.0;               ///< mean over pixels
};
/// Compares an image with a reference; throws an input Error unless display windows and bands
/// agree.
Comparison compare_images(const SpectralImage& image, const SpectralImage& reference);

} // namespace reradiant
