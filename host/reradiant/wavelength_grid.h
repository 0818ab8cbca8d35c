#pragma once

#include <vector>

namespace reradiant {

/// Equally spaced wavelength bands. Band i is centred at from_nm + i * step_nm and reaches half
/// a step to each side. A grid of one band has step_nm > 0 too: its width.
struct WavelengthGrid {
    double from_nm = 380.0; ///< centre of the first band
    double step_nm = 10.0;
    int count = 41;

    double centre_nm(int band) const { return from_nm + band * step_nm; }
    double lower_edge_nm(int band) const { return from_nm + (band - 0.5) * step_nm; }
    double upper_edge_nm(int band) const { return from_nm + (band + 0.5) * step_nm; }
    double to_nm() const { return centre_nm(count - 1); }
    /// Band whose half-open cell holds the wavelength; -1 outside.
    int band_of(double wavelength_nm) const;
    std::vector<double> centres_nm() const;

    bool operator==(const WavelengthGrid&) const = default;
};

/// Grid from centres given one by one. Throws std::invalid_argument (a sentence that says which
/// entry) unless they ascend in equal steps (to 1e-6 of a step). One centre: step as given.
WavelengthGrid grid_from_centres(const std::vector<double>& centres_nm,
                                 double step_of_single_nm = 1.0);

/// Grid from both end centres and a step; throws std::invalid_argument unless to - from is a
/// whole number of steps (to 1e-6 of a step), step > 0, from > 0 and count <= 100000.
WavelengthGrid grid_from_range(double from_nm, double to_nm, double step_nm);

} // namespace reradiant
