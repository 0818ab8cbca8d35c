#pragma once

#include "reradiant/scene.h"

#include <string>
#include <vector>

namespace reradiant {

/// A way to render a scene: what is compared where error is measured against time.
struct RenderMethod {
    std::string name; ///< as it was asked for
    Model model = Model::Auto;
    int comb_count = 0; ///< wavelengths a path; 0: one a film band
    int hero_count = 0; ///< sampled of them; 0: none, the path carries all

    bool adaptive = false;

    std::string file_stem() const; ///< the name, fit for a file
};

/// A model, a wavelength sampling, "adaptive", or some of them joined by a plus: "adding",
/// "comb:16", "hero:8", "weidlich-wilkie+comb+adaptive". std::invalid_argument says which part is
/// not known, and what is.
RenderMethod parse_method(const std::string& text);

/// Methods of --methods, separated by commas. Input Error for one that is not known, for an empty
/// list and for one that is named twice.
std::vector<RenderMethod> parse_methods(const std::string& list);

} // namespace reradiant
