#pragma once

#include "host/layers/models/sheet_transmission.h"
#include "host/layers/models/stack_bsdf.h"
#include "host/layers/sources/emitting_stack.h"
#include "host/layers/stack/substrate_values.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace reradiant {

/// A layered material at the band centres under one of the closed models: its albedo and the triple
/// eval, sample, pdf, which are what a goniophotometer and local shading ask of two given
/// directions, and what a path asks when it goes on along one ray. Unit vectors in the local frame
/// (z = normal), both pointing away. The walk's own triple is LayerWalk.
///
/// Light is `diffuse` where it reached the substrate, of whatever type; else `slab` where it was
/// scattered in a slab or sent out again by dyes in one; else `specular`. A sheet has two sides,
/// and directions with z < 0 lie below it.
///
/// Directions are chosen for all bands together: from the rough lobes of interfaces, flakes and a
/// conductor, from the cosine, or the mirror's, by the mean shares of the light that they carry.
/// The kernels do the same from tables (kernels/stack/layer_stack.h), whose functions are used
/// here.
class LayeredBsdf {
public:
    /// Input Error for what the model cannot do.
    LayeredBsdf(const LayerStack& stack, const SubstrateValues& substrate,
                const WavelengthGrid& bands, ClosedModel model);

    int bands() const { return static_cast<int>(stacks_.size()); }
    bool is_sheet() const { return !sheets_.empty(); }
    /// The model at a band, of a sheet as seen from above.
    const StackBsdf& at(int band) const { return whole(band, Side::Above); }
    /// The same without what slabs scatter.
    const StackBsdf& unscattered_at(int band) const { return unscattered(band, Side::Above); }
    /// (bands, bands), rows = emission: zero where no light can go from one band to another.
    const Eigen::MatrixXd& coupling() const { return coupling_; }
    /// The dyes' own light; null where no slab holds any.
    const EmittingStack* emitting() const { return emitting_.get(); }

    /// The BSDF without the cosine and without deltas, 1/sr, per band: (bands, bands), rows =
    /// emission; light comes from wi. Zero unless both are above the surface or this is a sheet.
    Eigen::MatrixXd eval(const kernels::Vec3& wi, const kernels::Vec3& wo) const;

    /// Light by where it has been: (bands, bands), rows = emission; specular light keeps its band.
    struct Parts {
        Eigen::MatrixXd diffuse, slab;
        Eigen::VectorXd specular;
    };
    /// The BSDF likewise, part by part, for directions on sides that there are.
    Parts parts(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
    /// Directional-hemispherical shares on a side, deltas included, unit 1.
    Parts albedo(const AirDirection& from, Side to) const;
    /// Radiance in a direction of light that comes from all directions of its side alike, over a
    /// perfect diffuser's, the mirror's reflection included: (bands, bands), rows = emission. For
    /// layers with dyes alone; without them it is the transposed albedo over a transposed matrix.
    Eigen::MatrixXd diffusely_lit(const AirDirection& to) const;
    /// Share that total reflection guides in a sheet for ever: (bands, bands), rows = emission.
    Eigen::MatrixXd guided(const AirDirection& from) const;
    /// The diffuse part of `parts` and of `albedo`, for directions above the surface.
    Eigen::MatrixXd diffuse(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
    Eigen::MatrixXd diffuse_albedo(double cos_theta) const;
    /// Weight of the mirror delta at every band, unit 1, and of the direction straight through a
    /// sheet.
    Eigen::VectorXd delta(double cos_theta, Side from = Side::Above) const;
    Eigen::VectorXd straight_on(double cos_theta) const;

    struct Sample {
        kernels::Vec3 w{}; ///< may lie below the surface: then nothing goes on, but of a sheet
        /// 1/sr, what `pdf` says of w; of the mirror, or of straight on: its probability, to divide
        /// `delta` or `straight_on` by
        double pdf = 0.0;
        bool is_delta = false;
    };
    /// Chooses the other direction for a given one (light or camera alike), from numbers in [0, 1).
    Sample sample(const kernels::Vec3& w, const std::array<double, 3>& random) const;
    /// Density of the directions that `sample` finds for w, 1/sr, deltas left out; 0 for `other`
    /// below the surface of what is no sheet.
    double pdf(const kernels::Vec3& w, const kernels::Vec3& other) const;

private:
    /// Probabilities of mirror, cosine and each lobe, and on the far side of a sheet.
    struct Choice {
        double mirror = 0.0, cosine = 1.0, lobe = 0.0; ///< lobe: of each one
        double straight = 0.0, far_cosine = 0.0, far_lobe = 0.0;
    };
    /// Choices over sqrt(cos), made when the first direction is asked for: they cost albedos.
    struct Choices;

    static std::shared_ptr<Choices> new_choices();
    bool like_the_last(int band) const;
    void make_models(ClosedModel model);
    void make_emitting(const LayerStack& stack, const WavelengthGrid& bands);
    const StackBsdf& whole(int band, Side side) const;
    const StackBsdf& unscattered(int band, Side side) const;
    template <typename WayOut, typename WayIn>
    Eigen::MatrixXd between(const WayOut& way_out, const WayIn& way_in) const;
    Eigen::MatrixXd conductor_albedo(double cos_theta) const;
    Eigen::MatrixXd joint_albedo(double cos_theta) const;
    std::vector<double> breaks_of_all(double cos_i) const;
    Choice choice_at_node(const AirDirection& from) const;
    Choice choice(const AirDirection& from) const;
    Sample sample_far(const kernels::Vec3& w, const Choice& chosen, double beyond,
                      const std::array<double, 3>& random) const;
    const LobeShape* far_lobe(Side from) const;

    std::vector<StackElements> stacks_;                                  ///< by band
    std::vector<std::shared_ptr<const StackBsdf>> models_, unscattered_; ///< empty for a sheet
    std::vector<std::shared_ptr<const SheetTransmission>> sheets_;
    std::shared_ptr<const EmittingStack> emitting_;
    bool has_conductor_;
    double sigma_;
    Eigen::MatrixXd first_, rest_; ///< M and B of oren_nayar_substrate.h
    Eigen::MatrixXd coupling_;
    std::array<std::vector<LobeShape>, 2> lobes_; ///< by side
    std::shared_ptr<Choices> choices_;
};

} // namespace reradiant
