#pragma once

#include <filesystem>

namespace reradiant {

enum class FileKind { Scene, Material, Matrix, Spectrum, Image };

/// What a file holds, by its ending and, where that leaves a choice, by its content: a .toml with
/// a [material] and no [film] is a material, a .csv whose first lines say so a matrix, an .exr with
/// T channels a matrix, a text that says it is JCAMP-DX, CGATS or IES TM-27 a spectrum. Input Error
/// for a file that cannot be opened or whose ending is not known.
FileKind file_kind(const std::filesystem::path& file);

} // namespace reradiant
