#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace reradiant {

/// A `WalkTally` holds the estimates, by band, that one walk or the mean over many walks gives for
/// a material.
struct WalkTally {
    /// Light by whether it reached the substrate. `diffuse` did: its shape is (bands, bands), rows
    /// = emission, for a fluorescent substrate, and (bands, 1), the diagonal, for any other.
    /// `specular` did not.
    struct Parts {
        Eigen::MatrixXd diffuse;
        Eigen::VectorXd specular;
    };
    Parts hemispherical;            ///< unit 1, deltas included
    std::vector<Parts> directional; ///< 1/sr without cosine, deltas left out, one a direction asked
    Eigen::VectorXd delta;          ///< share that smooth surfaces alone send out
    Eigen::VectorXd lost;           ///< share that single scattering loses before the substrate

    void set_zero();
};

/// A `WalkSample` is one path of light through a material, at a single wavelength at a time.
struct WalkSample {
    kernels::Vec3 w{};     ///< direction in which it leaves into the air
    int band = 0;          ///< in which it leaves
    double weight = 0.0;   ///< BSDF times cosine over probability; 0: it did not leave
    bool reached = false;  ///< true when it met the substrate
    bool is_delta = false; ///< smooth surfaces alone sent it there
};

/// A `WalkArrival` is light where it meets the substrate for the first time.
struct WalkArrival {
    kernels::Vec3 from{}; ///< away from the substrate, towards where it comes from
    double weight = 0.0;  ///< share of the light that it carries; 0: it left, or was absorbed
};

/// Model C: position-free random walk through a stack over a substrate (after Guo, Hasan and Zhao
/// 2018), unbiased, in double precision, with the wavelength shift inside the walk.
///
/// Light is followed from the incident direction; every event takes its place by its probability.
/// Towards a direction asked for, a second path (WalkConnector) comes down from there by what it
/// may do without a value of its own: refraction downwards and anything smooth. The two are
/// connected at every event that ends such a path: reflection at a rough surface, refraction out
/// of it downwards, scattering in a slab, the diffuse substrate. Every path of light has one such
/// last event, so that nothing is counted twice and no weights are needed.
///
/// One walk serves all bands and carries their weights when the stack differs between bands in its
/// absorption only. Otherwise each excitation band has walks of its own, and the substrate draws
/// the band of emission. Both give exactly the model's expectation, with any dispersion.
class LayerWalk {
public:
    /// Makes one band for each wavelength. Throws an input Error for numbers out of range.
    LayerWalk(const LayerStack& stack, const SubstrateValues& substrate,
              const std::vector<double>& wavelengths_nm);
    /// Makes a single band over a diffuse substrate. Throws as above.
    explicit LayerWalk(const StackElements& stack) : LayerWalk(WalkMaterial(stack)) {}

    int bands() const { return material_.bands(); }
    bool serves_all_bands() const { return material_.serves_all_bands(); }

    /// Adds one estimate to a tally made by `tally` for as many directions. wi and wo point away
    /// from the surface, in air. Depends on (seed, sample) and the arguments only.
    void eval(const kernels::Vec3& wi, std::span<const kernels::Vec3> wo, std::uint64_t seed,
              std::uint64_t sample, WalkTally& tally) const;
    WalkTally tally(std::size_t directions) const;

    /// Follows light that comes from wi in a band. The expectation of its weight over
    /// directions is the integral of eval times their cosine. Walks backwards, from a camera,
    /// are those of `reversed`.
    WalkSample sample(const kernels::Vec3& wi, int band, WalkRandom& random) const;

    /// Follows light that comes from wi in the first band to the substrate. The mean weight is the
    /// transmission of the stack without what the substrate sends back.
    WalkArrival arrival(const kernels::Vec3& wi, WalkRandom& random) const;

    /// Returns the material with light running backwards: eval(wi, wo)(lo, li) of one is eval(wo,
    /// wi)(li, lo) of the other. Under dispersion the reversal brings in n^2 of the lowest slab at
    /// both wavelengths.
    LayerWalk reversed() const;

private:
    explicit LayerWalk(WalkMaterial material) : material_(std::move(material)) {}

    WalkMaterial material_;
};

} // namespace reradiant
