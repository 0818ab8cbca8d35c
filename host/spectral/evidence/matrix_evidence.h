#pragma once

#include "reradiant/reradiation.h"

namespace reradiant {

/// `MatrixEvidence` holds what the numbers of a matrix say of how they are to be read. Entries that
/// were not measured (NaN) count as 0, and so does the fluorescence beside the diagonal in the sums
/// of energy, into which a monochromator's bandpass spills the reflectance.
struct MatrixEvidence {
    double stokes = 0.0;      ///< energy in emission above the excitation, at least 0
    double anti_stokes = 0.0; ///< the same below the excitation
    /// The larger of the two is more than what noise adds up to (five standard deviations of it).
    bool stands_out = false;
    /// Most photons that an excitation band has re-emitted above it, per photon that it receives.
    double photons = 0.0;
    double photons_nm = 0.0;     ///< that excitation band
    double largest_energy = 0.0; ///< the largest sum that an excitation band returns of its energy

    double anti_stokes_share() const;
};

MatrixEvidence evidence_of(const ReradiationMatrix& matrix);

/// Returns the same numbers with rows and columns exchanged, as if read with the other orientation.
ReradiationMatrix exchanged(const ReradiationMatrix& matrix);

/// Photons that a strong or a weak fluorescent sample re-emits of those in its best excitation
/// band: measured pigments, papers and textiles have 0.17 to 0.75 (seven of a BFC-450, two of
/// iccDEV). A tenth of one is 5 to 10 times too little for them, which is what reading values per
/// nm as values per band of 5 to 10 nm gives; above one it is impossible, up to the error of the
/// scale.
constexpr double fewest_photons = 0.1, most_photons = 1.2;

/// From this share of its fluorescence on, a side of the diagonal is the emission: measured samples
/// have 92 to 100 % of it on that side.
constexpr double emission_share = 0.75;

inline bool has_usual_photons(double photons) {
    return photons >= fewest_photons && photons <= most_photons;
}

/// True where so many photons are re-emitted as values per band give that are taken as per nm.
inline bool was_taken_as_density(const MatrixEvidence& evidence, double excitation_step_nm) {
    return evidence.photons > most_photons &&
           has_usual_photons(evidence.photons / excitation_step_nm);
}

} // namespace reradiant
