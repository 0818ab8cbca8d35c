#pragma once

#include "host/figure/figure.h"
#include "host/film/region_values.h"
#include "reradiant/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A place of an image whose spectrum and colour are shown.
struct MarkRequest {
    std::string name, label;
    ImageRegion region;
    SourcePosition position;
};

/// What a figure's file says of an image.
struct ImageRequest {
    std::string name, title;
    std::filesystem::path file;
    SourcePosition position;
    LightFactors light_factors = {}; ///< of the image's light groups
    SourcePosition light_position = {};
    DevelopOptions develop;
    bool has_shared_exposure = false; ///< that of all such images, which is chosen by them together
    std::optional<ImageRegion> crop = {};
    SourcePosition crop_position = {};
    std::vector<MarkRequest> marks = {};
};

/// A mark by its image's place in the request, and its own place in the image.
struct MarkReference {
    std::size_t image = 0, mark = 0;
};

struct PlotRequest {
    std::string name, title;
    std::vector<MarkReference> marks;
    std::optional<MarkReference> against = {}; ///< ratios to this mark are shown
    bool is_logarithmic = false;
    double from_nm = 0.0, to_nm = 1e9; ///< bands whose centres lie within are shown
    double aspect = 0.0;
};

struct SwatchRequest {
    std::string name, title;
    std::vector<MarkReference> marks;
    std::optional<MarkReference> against = {}; ///< CIEDE2000 to this mark is shown
    std::string lamp;                          ///< whose white Lab is relative to
    Xyz white{};
    double aspect = 0.0;
};

/// A panel by its kind and its place among those of the kind.
struct PanelReference {
    enum class Kind { Image, Plot, Swatches } kind = Kind::Image;
    std::size_t index = 0;
};

struct FigureRequest {
    Figure page; ///< without rows
    double dpi = 300.0;
    std::vector<ImageRequest> images;
    std::vector<PlotRequest> plots;
    std::vector<SwatchRequest> swatches;
    std::vector<std::vector<PanelReference>> rows;

    const MarkRequest& mark(const MarkReference& reference) const {
        return images[reference.image].marks[reference.mark];
    }
};

/// Reads a FIGURE.toml; images are looked for, but not read. Input Error with line and column for
/// unknown keys, names that stand for nothing, and values out of range.
FigureRequest read_figure_request(const std::filesystem::path& file);

} // namespace reradiant
