#pragma once

#include "host/spectral/colour/band_sums.h"
#include "reradiant/colour_of_matrix.h"

#include <array>
#include <optional>
#include <vector>

namespace reradiant {

/// `LampColours` are the colours of any number of matrices under one lamp, for one observer. What
/// does not depend on a matrix is summed once for each pair of grids.
class LampColours {
public:
    LampColours(Spectrum illuminant, ColourSum sum, ColourConditions conditions = {});

    /// As colour_of_matrix. `at_nanometres` decides in place of ColourSum::Automatic.
    MatrixColour colour_of(const ReradiationMatrix& matrix, std::optional<bool> at_nanometres = {});
    /// As plain_sums_misjudge.
    LampError plain_sums_misjudge(const ReradiationMatrix& matrix);

private:
    /// What matrices on the same grids share. Made where it is asked for.
    struct OnGrids {
        WavelengthGrid emission, excitation;
        std::array<std::optional<BandSums>, 3> sums;             ///< by SumRange
        std::array<std::optional<std::vector<double>>, 2> light; ///< at the bands, mean in them
    };

    OnGrids& on_grids(const ReradiationMatrix& matrix);
    const BandSums& sums(OnGrids& grids, SumRange range) const;
    const std::vector<double>& light(OnGrids& grids, bool at_nanometres) const;
    void fill_radiance_factors(MatrixColour& colour, const Exitance& exitance,
                               OnGrids& grids) const;

    Spectrum illuminant_;
    ColourSum sum_;
    ColourConditions conditions_;
    std::vector<OnGrids> grids_;
};

} // namespace reradiant
