#pragma once

#include "reradiant/wavelength_grid.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
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

/// Which of a group's light a layer is of. Where something fluoresces, light that lamps send below
/// 400 nm and what they send above are kept apart: what the one excites is not in the other.
enum class LightPart { Whole, Ultraviolet, Visible };

/// A `LightLayer` is what one group of lights adds to an image, or what a part of that group's
/// light does. The layers of an image add up to it.
struct LightLayer {
    std::string group;
    LightPart part = LightPart::Whole;
    double from_nm = 0.0, to_nm = 0.0; ///< what the lights send between these counts
    /// Means of the lights' spectrum over cells of 1 nm (lamp_cells); empty where the group's
    /// lights differ by more than a factor.
    std::vector<double> lamp;
    std::vector<float> values; ///< (height, width, band) as those of the image

    /// "GROUP", "GROUP.uv" or "GROUP.visible".
    std::string name() const;
};

/// Cells of 1 nm that lamps are kept on; their centres begin at lamp_from_nm.
constexpr int lamp_from_nm = 280, lamp_cells = 561;

/// Writes an image as write_spectral_exr does, and its layers as parts of their own behind it,
/// which readers of spectral images pass over.
void write_spectral_exr(const std::filesystem::path& file, const SpectralImage& image,
                        double exposure_ev, std::span<const LightLayer> layers);
/// Layers without their values; an image without light groups has none. Only headers are read.
/// Input Error for a file whose layers are damaged.
std::vector<LightLayer> light_layers_of(const std::filesystem::path& file);
/// Reads layers one after the other. Input Error as read_spectral_exr has it, and for layers of
/// another size or other bands than the image.
void read_light_layers(const std::filesystem::path& file,
                       const std::function<void(LightLayer&&)>& use);

/// Factors by the name of a group, or of one of its layers. A layer's factor is the product of
/// both.
using LightFactors = std::map<std::string, double>;

/// Reads an image with its lights turned up or down: the sum of its layers, each times its factor;
/// lights without one keep theirs of 1. Variances are not known of such a sum and are left out.
/// Input Error for an image without layers and for a name that is not among them.
SpectralImage read_relit_image(const std::filesystem::path& file, const LightFactors& factors);

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
