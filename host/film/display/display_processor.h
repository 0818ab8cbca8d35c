#pragma once

#include "host/film/display/develop.h"

#include <OpenColorIO/OpenColorIO.h>

#include <Eigen/Core>

#include <optional>

namespace reradiant {

/// A way from CIE XYZ (white D65 with Y = 1) to a display's code values, by OpenColorIO.
struct DisplayProcessor {
    OCIO_NAMESPACE::ConstCPUProcessorRcPtr processor;
    PictureEncoding encoding;
    /// XYZ (columns) of the display's red, green and blue at their largest codes, which add up to
    /// its white; empty where a configuration's view decides what is shown.
    std::optional<Eigen::Matrix3d> xyz_of_primaries;
};

/// The processor of a configuration (the option, else $OCIO), or of one of OpenColorIO's own
/// displays. Input Error for a configuration, display or view that there is not, with the names
/// that there are.
DisplayProcessor display_processor(const DisplayOptions& options);

} // namespace reradiant
