#pragma once

#include "host/measure/surface_model.h"
#include "reradiant/scene.h"

#include <Eigen/Core>
#include <array>

namespace reradiant {

/// A layered material at the band centres under one of the closed models as the triple eval,
/// sample, pdf: what local shading asks of two given directions, and what a path asks when it goes
/// on along one ray. Unit vectors in the local frame (z = normal), both pointing away. The walk's
/// own triple is LayerWalk.
///
/// Directions are chosen for all bands together: from the rough lobes of interfaces, flakes and a
/// conductor, from the cosine, or the mirror's, by the mean shares of the light that they carry.
/// The kernels do the same from tables (kernels/stack/layer_stack.h), whose functions are used
/// here.
class LayeredBsdf {
public:
    /// Model Adding or WeidlichWilkie; Input Error for others and for what the model cannot do.
    LayeredBsdf(const LayerStack& stack, const SubstrateValues& substrate,
                const WavelengthGrid& bands, Model model);

    /// The BSDF without the cosine and without deltas, 1/sr, per band: (bands, bands), rows =
    /// emission; light comes from wi. Zero unless both are above the surface.
    Eigen::MatrixXd eval(const kernels::Vec3& wi, const kernels::Vec3& wo) const;
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
    static constexpr int nodes = 9; ///< over sqrt(cos)
    /// Probabilities of mirror, cosine and each lobe.
    struct Choice {
        double mirror = 0.0, cosine = 1.0, lobe = 0.0; ///< lobe: of each one
    };
    Choice choice_at_node(double cos_theta) const;
    Choice choice(double cos_theta) const;

    std::unique_ptr<SurfaceModel> surface_;
    std::vector<AddingTransport::Lobe> lobes_;
    int bands_;
    std::array<Choice, nodes> choices_;
};

} // namespace reradiant
