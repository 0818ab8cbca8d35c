#pragma once

#include "host/spectral/evidence/scatter_line.h"
#include "reradiant/reradiation.h"

#include <optional>

namespace reradiant {

/// `ScatterSettings` holds what is known of a measured matrix before lines of scatter are looked
/// for in it.
struct ScatterSettings {
    double spill_nm = 0.0; ///< entries this near to the diagonal are known to hold reflected light
    bool anti_stokes = false; ///< emission below excitation counts, too
};

/// A `ScatterStencil` says where the neighbours lie that an entry is compared with: farther than
/// the clearance from the line, and from the line moved by shift_nm along the emission.
struct ScatterStencil {
    double shift_nm, clearance_nm;
};

/// Compares entries of a measured matrix with their neighbours across a line of scatter. Holds
/// references to the matrix.
class ScatterContrast {
public:
    ScatterContrast(const ReradiationMatrix& matrix, const ScatterSettings& settings,
                    ScatterOrder order)
        : matrix_(matrix), settings_(settings), is_first_(order == ScatterOrder::First),
          ratio_(scatter_ratio(order)) {}

    /// Emission less that of the line.
    double distance_nm(int o, int i) const {
        return matrix_.emission.centre_nm(o) - ratio_ * matrix_.excitation.centre_nm(i);
    }
    /// Entries that say something: measured, where fluorescence may be, and beyond the spill.
    bool is_usable(int o, int i) const;

    /// Returns how far an entry exceeds what its neighbours along the emission and those along the
    /// excitation say, whichever say more; empty where one of the two has none. A narrow band of
    /// either spectrum stands out of one of the two only, a line that moves with the excitation
    /// stands out of both.
    std::optional<double> operator()(int o, int i, const ScatterStencil& stencil) const;

private:
    struct Neighbour {
        double value, away_nm;
    };
    std::optional<Neighbour> neighbour(int o, int i, int down, int right,
                                       const ScatterStencil& stencil) const;
    std::optional<double> expected(int o, int i, int down, int right,
                                   const ScatterStencil& stencil) const;

    const ReradiationMatrix& matrix_;
    ScatterSettings settings_;
    bool is_first_;
    double ratio_;
};

} // namespace reradiant
