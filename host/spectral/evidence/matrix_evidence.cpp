#include "host/spectral/evidence/matrix_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reradiant {

namespace {

constexpr double noise_deviations = 5.0;
/// Entries beside the diagonal are within this many of the coarser steps of it: a bandpass as wide
/// as the step reaches the next band.
constexpr double spill_steps = 1.5;

/// The energy of one side of the diagonal, with its noise should it hold no more than that.
struct Side {
    double sum = 0.0, squares = 0.0;
    int entries = 0;

    void add(double energy) {
        sum += energy;
        squares += energy * energy;
        ++entries;
    }
    double mean() const { return entries == 0 ? 0.0 : sum / entries; }
    double rms() const { return entries == 0 ? 0.0 : std::sqrt(squares / entries); }
};

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0.0;
}

} // namespace

double MatrixEvidence::anti_stokes_share() const {
    const double both = stokes + anti_stokes;
    return both > 0.0 ? anti_stokes / both : 0.0;
}

MatrixEvidence evidence_of(const ReradiationMatrix& matrix) {
    const WavelengthGrid &emission = matrix.emission, &excitation = matrix.excitation;
    const double steps = emission.step_nm / excitation.step_nm;
    const double spill_nm = spill_steps * std::max(emission.step_nm, excitation.step_nm);
    MatrixEvidence evidence;
    Side above, below;
    for (int i = 0; i < excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        double photons = 0.0, total = 0.0;
        for (int o = 0; o < emission.count; ++o) {
            const double value = finite_or_zero(matrix.values(o, i));
            const double energy = value * (o == diagonal ? 1.0 : steps);
            const double shift_nm = emission.centre_nm(o) - excitation.centre_nm(i);
            total += energy;
            if (o == diagonal)
                continue;
            if (shift_nm > 0.0)
                photons += energy * emission.centre_nm(o) / excitation.centre_nm(i);
            if (std::abs(shift_nm) > spill_nm)
                (shift_nm > 0.0 ? above : below).add(energy);
        }
        if (photons > evidence.photons) {
            evidence.photons = photons;
            evidence.photons_nm = excitation.centre_nm(i);
        }
        evidence.largest_energy = std::max(evidence.largest_energy, total);
    }
    evidence.stokes = std::max(above.sum, 0.0);
    evidence.anti_stokes = std::max(below.sum, 0.0);
    // The side with less light shows the noise of both, and the offset that clipped noise has.
    const auto [less, more] =
        above.sum < below.sum ? std::pair{&above, &below} : std::pair{&below, &above};
    evidence.stands_out = more->sum - std::max(less->mean(), 0.0) * more->entries >
                          noise_deviations * less->rms() * std::sqrt(more->entries);
    return evidence;
}

ReradiationMatrix exchanged(const ReradiationMatrix& matrix) {
    ReradiationMatrix other = matrix;
    std::swap(other.emission, other.excitation);
    other.values = matrix.values.transpose().eval();
    return other;
}

} // namespace reradiant
