#pragma once

#include "reradiant/spectral_image.h"

#include <ImfMultiPartInputFile.h>

#include <filesystem>

namespace reradiant {

/// The first part with a spectrum; the first of all where none has one.
int spectral_part(const Imf::MultiPartInputFile& input);

/// Reads one part of a file as a spectral image, as read_spectral_exr does the first.
SpectralImage read_spectral_part(Imf::MultiPartInputFile& input, int part,
                                 const std::filesystem::path& file);

} // namespace reradiant
