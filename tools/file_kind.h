#pragma once

#include <filesystem>

namespace reradiant {

enum class FileKind {
    Scene,
    Material,
    Layers, ///< a material without a substrate, as `fit --stack` takes it
    Recipe, ///< of synth
    Study,
    Matrix,
    Measurement, ///< the CSV of `measure`
    Spectrum,
    ComplexIndex, ///< nm,n,k of a metal
    Polygons,     ///< regions of `colour --polygons`
    Mesh,
    Image,
    DisplayConfig ///< of OpenColorIO
};

/// What a file holds, by its ending and, where that leaves a choice, by its content: a .toml by its
/// tables, an .exr with T channels is a matrix, a text what its first lines say, else a spectrum.
/// Input Error for a file that cannot be opened.
FileKind file_kind(const std::filesystem::path& file);

} // namespace reradiant
