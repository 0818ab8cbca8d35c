#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "host/layers/walk/walk_tally.h"
#include "kernels/core/portable.h"

#include <span>
#include <vector>

namespace reradiant {

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

/// Model C: position-free random walk through a stack over a substrate, or through a sheet (after
/// Guo, Hasan and Zhao 2018), unbiased, in double precision, with the wavelength shift inside the
/// walk.
///
/// Light is followed from the incident direction; every event takes its place by its probability.
/// Towards a direction asked for, a second path (WalkConnector) comes in from there by what it may
/// do without a value of its own: refraction inwards and anything smooth. The two are connected at
/// every event that ends such a path: reflection at a rough surface, refraction by it the other
/// way, the first event of light that has met smooth surfaces only, scattering and re-emission in a
/// slab, the diffuse substrate. Every path of light has one last such event, so that nothing is
/// counted twice and no weights are needed.
///
/// One walk serves all bands and carries their weights when the stack differs between bands in its
/// absorption only and holds no dyes. Otherwise each excitation band has walks of its own, and
/// dyes and the substrate draw the band of emission. Both give exactly the model's expectation,
/// with any dispersion.
class LayerWalk {
public:
    /// Makes one band for each wavelength. `emissions`: what the slabs' dyes send out
    /// (slab_emissions), or nothing where none holds a dye. A sheet's substrate is not looked at.
    /// Throws an input Error for numbers out of range, and std::invalid_argument where dyes are not
    /// told what they send out.
    LayerWalk(const LayerStack& stack, const SubstrateValues& substrate,
              const std::vector<double>& wavelengths_nm,
              const std::vector<Eigen::MatrixXd>& emissions = {})
        : LayerWalk(WalkMaterial(stack, substrate, wavelengths_nm, emissions)) {}
    /// Makes a single band over a diffuse substrate; dyes send out nothing. Throws as above.
    explicit LayerWalk(const StackElements& stack) : LayerWalk(WalkMaterial(stack)) {}

    int bands() const { return material_.bands(); }
    bool serves_all_bands() const { return material_.serves_all_bands(); }

    /// Adds one estimate to a tally made by `tally` for as many directions. wi and wo point away
    /// from the surface, in air; those of sheets may lie on either side, z < 0 below. Depends on
    /// (seed, sample) and the arguments only. std::invalid_argument for any other direction.
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
    /// wi)(li, lo) of the other. Under dispersion the reversal brings in n^2, at both wavelengths,
    /// of the medium that sends the light out.
    LayerWalk reversed() const;

private:
    explicit LayerWalk(WalkMaterial material) : material_(std::move(material)) {}

    void check_direction(const kernels::Vec3& w) const;

    WalkMaterial material_;
};

} // namespace reradiant
