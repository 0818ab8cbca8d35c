#pragma once

#include "reradiant/error.h"
#include "reradiant/scene.h"

#include <ImfHeader.h>

namespace reradiant {

/// What the channels of an EXR image stand for.
enum class ExrColours { Rgb, LuminanceChroma, Xyz, Grey };

/// Makes linear sRGB of an image whose three values a pixel are such colours, R, G and B by the
/// header's chromaticities. The XYZ of a pixel stays, whatever white the file has: nothing adapts.
/// Input Error at `at` for chromaticities of no colour space, and for a pixel outside the gamut.
void convert_to_linear_srgb(Image& image, const Imf::Header& header, ExrColours colours,
                            const SourcePosition& at);

} // namespace reradiant
