#pragma once

#include "reradiant/spectral_image.h"
#include "reradiant/spectrum.h"

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace reradiant {

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
/// Means of a lamp over these cells.
std::vector<double> lamp_cell_means(const Spectrum& lamp);

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

} // namespace reradiant
