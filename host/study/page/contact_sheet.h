#pragma once

#include "host/study/study/study.h"

namespace reradiant {

/// Rows and columns that cells are laid out in: the first half of the sweeps runs down, the rest
/// runs across, the last fastest.
struct SheetLayout {
    std::size_t row_sweeps = 0; ///< sweeps that run down
    std::size_t rows = 1, columns = 1;
};
SheetLayout sheet_layout(const Study& study);

/// Pictures of all cells side by side at the result's exposure, beneath the values that were swept;
/// cells that failed, or were not done, are grey and say so. The cells' own pictures, image.png,
/// are written anew at it: what it is, only all cells together tell. Writes nothing when no cell
/// has an image.
void write_contact_sheet(const std::filesystem::path& file, const Study& study,
                         const StudyResult& result);

} // namespace reradiant
