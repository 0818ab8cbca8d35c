#pragma once

#include "host/scene/document/load_state.h"

namespace reradiant {

/// An `ImageEncoding` says what the numbers of an image file stand for. `Srgb` means colours: a PNG
/// holds sRGB; an EXR is linear and is converted to linear sRGB by its chromaticities. `Linear`
/// means data: the numbers are taken as they are.
enum class ImageEncoding { Srgb, Linear };

/// Returns the index into LoadState::images of the PNG or EXR that `name` means at `at`; a file is
/// read once per encoding. Alpha is ignored (colours of an EXR are multiplied by it already: the
/// image lies over black), and grey becomes three equal channels. Throws an input Error at `at` for
/// a missing file or another kind of file, and at the file when it is damaged, holds numbers that
/// are not finite, or has more than MAX_IMAGE_PIXELS (before memory is taken for them).
int load_image(const std::string& name, const SourcePosition& at, ImageEncoding encoding,
               LoadState& state);

/// 12 bytes each: 768 MB.
inline constexpr std::uint64_t MAX_IMAGE_PIXELS = std::uint64_t{64} << 20;
/// Refuses a size beyond the limit.
void check_image_size(const std::filesystem::path& file, std::uint64_t width, std::uint64_t height);

/// Each of these reads one file format and fills width, height and rgb of the image. An EXR has the
/// size of its display window and is black outside its data window.
Image read_png_image(const std::filesystem::path& file, ImageEncoding encoding);
Image read_exr_image(const std::filesystem::path& file, ImageEncoding encoding);

} // namespace reradiant
