#pragma once

#include "reradiant/stack_elements.h"

#include <vector>

namespace reradiant {

/// A pile of plane-parallel media with smooth interfaces between them: from above, media
/// ior[0] ... ior[m] with optical depths tau[0] ... tau[m] (0 for a medium without thickness).
/// film[k] lies on the interface between media k and k + 1; none when the list is shorter.
struct SmoothStack {
    std::vector<double> ior;
    std::vector<double> tau;
    std::vector<FilmValues> film = {};
    double wavelength_nm = 0.0; ///< for the interference in films
};

/// Returns the pile that light meets in a run of elements beneath a medium of IOR `ior_above`:
/// their media, each with its slab's depth. A scattering slab just above the run or just below it
/// ends the pile in its medium and counts there as clear.
SmoothStack smooth_pile(double ior_above, std::span<const StackElement> run);

/// A `SmoothResponse` holds what a pile transmits and reflects of a flux along one refracted path.
/// `transmission` holds in both directions (reciprocity). `loss_up` is 1 - (share of flux from
/// below that comes back down); it is kept instead of the reflectance because it is a sum of
/// positive terms and never cancels.
struct SmoothResponse {
    double transmission = 1.0;
    double reflection_down = 0.0; ///< reflectance for flux from above
    double loss_up = 1.0;
    double reflection_up() const { return 1.0 - loss_up; }
};

/// Returns the response of a pile after all interreflections, added in closed form, at the
/// direction whose cosine is `cosine` in a reference medium of index `reference_ior`. Cosines in
/// the other media follow from the invariant n^2 cos^2 = n^2 - n_ref^2 + n_ref^2 cos_ref^2, which
/// cancels nothing when the reference is the thinnest medium. Media in which the path is evanescent
/// reflect it totally. A lossless trap (both sides of a medium reflect totally) is unreachable from
/// outside and answers with transmission 0.
SmoothResponse smooth_response(const SmoothStack& stack, double reference_ior, double cosine);

/// Returns the response as `smooth_response` does, for a path given by n_ref^2 cos_ref^2, which is
/// negative where the path is evanescent in the reference medium.
SmoothResponse smooth_response_g2(const SmoothStack& stack, double reference_ior,
                                  double reference_g2);

/// Fresnel transmittance and reflectance between two media for unpolarised light, from g = n cos
/// on both sides squared: reflectance and transmittance are both free of cancellation.
struct FresnelPair {
    double transmittance, reflectance;
};
FresnelPair fresnel_pair(double n_above, double n_below, double g2_above, double g2_below);
/// Returns the same with a film on the interface, if it has a thickness.
FresnelPair filmed_pair(double n_above, double n_below, double g2_above, double g2_below,
                        const FilmValues& film, double wavelength_nm);

} // namespace reradiant
