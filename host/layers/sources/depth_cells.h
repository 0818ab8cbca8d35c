#pragma once

#include <vector>

namespace reradiant {

/// Cells of depth in which what a dyed slab sends out is uniform. From each face inwards they lie
/// in octaves, each as thick as all that is nearer to the face, and every octave is cut into equal
/// cells, a power of two of them: all thicknesses are the thinnest times powers of two, and twice
/// the cells are the same cells cut in halves.
struct DepthCells {
    int octaves = 0;          ///< from a face to the middle
    int cells_per_octave = 1; ///< a power of two

    int count() const { return 2 * octaves * cells_per_octave; }
    /// Thickness of a cell in those of the thinnest one, as a power of two.
    int doublings(int cell) const;
    /// Thickness of a cell as a share of the slab's.
    double share(int cell) const;

    bool operator==(const DepthCells&) const = default;
};

/// Returns cells whose first octave is at most half a free path at an optical depth, of normal
/// passage through the slab.
DepthCells depth_cells(double largest_depth, int cells_per_octave);

/// Cells of every slab of a stack, from the air down; a slab without dyes has no octaves.
using StackCells = std::vector<DepthCells>;

} // namespace reradiant
