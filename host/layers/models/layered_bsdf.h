#pragma once

#include "host/layers/models/stack_bsdf.h"
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
/// Light is `diffuse` where it reached the substrate, of whatever type, and `specular` where it
/// never did; what a band says of the latter is its StackBsdf's.
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

    int bands() const { return static_cast<int>(models_.size()); }
    const StackBsdf& at(int band) const { return *models_[static_cast<std::size_t>(band)]; }
    /// (bands, bands), rows = emission: zero where no light can go from one band to another.
    const Eigen::MatrixXd& coupling() const { return rest_; }

    /// The BSDF without the cosine and without deltas, 1/sr, per band: (bands, bands), rows =
    /// emission; light comes from wi. Zero unless both are above the surface.
    Eigen::MatrixXd eval(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
    /// The diffuse part of it, for directions above the surface.
    Eigen::MatrixXd diffuse(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
    /// Directional-hemispherical share of the diffuse part, the delta of a smooth conductor
    /// included: (bands, bands), rows = emission, unit 1. That of the specular part is
    /// specular_albedo of each band.
    Eigen::MatrixXd diffuse_albedo(double cos_theta) const;
    /// Weight of the mirror delta at every band, unit 1.
    Eigen::VectorXd delta(double cos_theta) const;

    struct Sample {
        kernels::Vec3 w{}; ///< may lie below the surface: then nothing goes on
        /// 1/sr, what `pdf` says of w; of the mirror: its probability, to divide `delta` by
        double pdf = 0.0;
        bool is_delta = false;
    };
    /// Chooses the other direction for a given one (light or camera alike), from numbers in [0, 1).
    Sample sample(const kernels::Vec3& w, const std::array<double, 3>& random) const;
    /// Density of the directions that `sample` finds for w, 1/sr, the mirror left out; 0 for
    /// `other` below the surface.
    double pdf(const kernels::Vec3& w, const kernels::Vec3& other) const;

private:
    /// Probabilities of mirror, cosine and each lobe.
    struct Choice {
        double mirror = 0.0, cosine = 1.0, lobe = 0.0; ///< lobe: of each one
    };
    /// Choices over sqrt(cos), made when the first direction is asked for: they cost albedos.
    struct Choices;

    bool like_the_last(int band) const;
    template <typename WayOut, typename WayIn>
    Eigen::MatrixXd between(const WayOut& way_out, const WayIn& way_in) const;
    Eigen::MatrixXd conductor_albedo(double cos_theta) const;
    Eigen::MatrixXd joint_albedo(double cos_theta) const;
    std::vector<double> breaks_of_all(double cos_i) const;
    Choice choice_at_node(double cos_theta) const;
    Choice choice(double cos_theta) const;

    std::vector<StackElements> stacks_; ///< by band
    std::vector<std::shared_ptr<const StackBsdf>> models_;
    bool has_conductor_;
    double sigma_;
    Eigen::MatrixXd first_, rest_; ///< M and B of oren_nayar_substrate.h
    std::vector<LobeShape> lobes_;
    std::shared_ptr<Choices> choices_;
};

} // namespace reradiant
