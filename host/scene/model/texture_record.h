#pragma once

#include "kernels/core/shared.h"
#include "reradiant/scene.h"

#include <cstdint>

namespace reradiant {

/// Returns what kernels read of a texture, but for its image.
TextureRecord texture_record(const Texture& texture);

/// Says in the record of an image's texture how large the image is and where its texels begin.
void set_image(const Image& image, std::uint32_t offset, TextureRecord& record);

} // namespace reradiant
