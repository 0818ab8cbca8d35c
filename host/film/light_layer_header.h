#pragma once

#include "reradiant/spectral_image.h"

#include <ImfHeader.h>

namespace reradiant {

/// Gives the header of a layer's part the attributes that light_layers_of reads.
void describe_layer(Imf::Header& header, const LightLayer& layer);

} // namespace reradiant
