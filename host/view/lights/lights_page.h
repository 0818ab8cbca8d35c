#pragma once

#include "host/spectral/colour/lamp.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A page to turn the lights of a picture up and down: one HTML file that fetches nothing.
struct LightsPage {
    std::filesystem::path image;
    std::vector<Lamp> lamps; ///< in the order of the page's lists, before usual ones
};

/// Returns the page's HTML. An image without light groups is one light's. Pictures of more than a
/// million pixels are shown by means of blocks. Input Error as read_spectral_exr and
/// read_light_layers have it, and for an image without light.
std::string lights_page(const LightsPage& page);

} // namespace reradiant
