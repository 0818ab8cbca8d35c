#pragma once

#include "host/device/source.h"

#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// `RenderFeatures` says what a scene needs of the kernels: one bit for each of
/// kernels/core/feature_bits.h, and the sizes that are compiled in. Everything else is an argument
/// of the kernels.
struct RenderFeatures {
#define FEATURE_BIT(name, why_off) bool name = false;
#include "kernels/core/feature_bits.h"
#undef FEATURE_BIT
    int chunks = 1, film_chunks = 1, lobes = 0;
    int hero = 0;           ///< wavelengths of a path's set; 0: all lanes
    int walk_layers = 1;    ///< most layers of a material that is walked through
    int dye_channels = 1;   ///< most channels of a material with dyes
    bool in_double = false; ///< directions, probabilities and factors in double precision

    static RenderFeatures all();
    /// All bits off but one; std::invalid_argument lists the names when there is none such.
    static RenderFeatures only(const std::string& name);

    /// Adds what `other` needs: its bits, and its lobes and layers where they are more.
    void add(const RenderFeatures& other);
    /// True when paths may end with light that they meet: they then have a vertex more.
    bool has_emitters_to_meet() const {
        return area_lights || distant_lights || environment || environment_image;
    }
    bool samples_lights() const {
        return area_lights || delta_lights || spot_lights || distant_lights || environment_image;
    }
    /// True when images colour lights or reflectances, so that vertices keep colours.
    bool has_colours() const {
        return environment_image || reflectance_image;
    }

    KernelDefines defines() const;
    /// Name to on/off, for the statistics.
    std::map<std::string, bool> listed() const;
    /// A line for every bit that is off, and why.
    std::vector<std::string> left_out() const;
};

/// Components that a direction is chosen among (CHOICES in kernels/stack/layer_stack.h).
inline int choice_count(const RenderFeatures& features) {
    return 3 + features.lobes + (features.sheets ? 3 : 0);
}

} // namespace reradiant
