#pragma once

#include <filesystem>

namespace reradiant {

enum class FileKind {
    Scene,
    Material,
    Layers, ///< a material without a substrate, as `fit --stack` takes it
    Recipe, ///< the input of `synth`
    Study,
    Figure,
    Matrix,
    Covariance,  ///< of a matrix: the CSV of `fit --covariance`
    Measurement, ///< the CSV of `measure`
    Spectrum,
    ComplexIndex, ///< nm,n,k of a metal
    Polygons,     ///< regions of `colour --polygons`
    Mesh,
    Image,
    DisplayConfig ///< a configuration of OpenColorIO
};

/// Returns the kind of a file by its ending and, where that leaves a choice, by its content: a
/// .toml is told by its tables, an .exr with T channels is a matrix, and a text file is what its
/// first lines say, else a spectrum. Throws an input Error for a file that cannot be opened.
FileKind file_kind(const std::filesystem::path& file);

} // namespace reradiant
