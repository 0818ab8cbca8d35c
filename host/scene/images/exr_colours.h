#pragma once

#include "reradiant/error.h"
#include "reradiant/scene.h"

#include <ImfHeader.h>

namespace reradiant {

/// `ExrColours` names what the channels of an EXR image stand for.
enum class ExrColours { Rgb, LuminanceChroma, Xyz, Grey };

/// Converts an image, whose three values a pixel are such colours, to linear sRGB; R, G and B are
/// read by the chromaticities of the header. The XYZ of a pixel is kept, whatever white the file
/// has: there is no chromatic adaptation. Throws an input Error at `at` for chromaticities that
/// span no colour space, and for a pixel outside the gamut.
void convert_to_linear_srgb(Image& image, const Imf::Header& header, ExrColours colours,
                            const SourcePosition& at);

} // namespace reradiant
