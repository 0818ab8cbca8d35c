#pragma once

#include "host/layers/stack/substrate_values.h"
#include "host/layers/walk/walk_surface.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// A `WalkElement` is a StackElement made ready for the walk: with what its surface gives back of
/// lost light, and with the absorption of all bands that one walk carries.
struct WalkElement {
    enum class Kind { Surface, Slab, Flakes, Conductor, Diffuse };
    Kind kind = Kind::Surface;
    WalkSurface surface{}; ///< interface, flakes, conductor
    double ior = 1.0;      ///< IOR of the slab, or of the medium above any other element
    Eigen::ArrayXd tau{};  ///< slab: depth of absorption at every band that is carried
    double tau_scattering = 0.0, anisotropy = 0.0;
    double coverage = 0.0; ///< flakes
    double sigma = 0.0;    ///< diffuse
};
using WalkElements = std::vector<WalkElement>;

/// A material as lists of elements.
class WalkMaterial {
public:
    WalkMaterial(const LayerStack& stack, const SubstrateValues& substrate,
                 const std::vector<double>& wavelengths_nm);
    /// One band, over a diffuse substrate that sends all light back.
    explicit WalkMaterial(const StackElements& stack);

    int bands() const { return static_cast<int>(by_band_.size()); }
    /// True when all bands go the same ways: they differ in absorption and re-radiation alone.
    bool serves_all_bands() const { return !shared_.empty(); }
    bool is_fluorescent() const { return fluorescent_; }
    const Eigen::MatrixXd& matrix() const { return matrix_; }

    const WalkElements& shared() const { return shared_; }
    const WalkElements& at_band(int band) const { return by_band_[static_cast<std::size_t>(band)]; }
    WalkMaterial reversed() const;

private:
    WalkElements shared_; ///< with the absorption of all bands; empty: they go different ways
    std::vector<WalkElements> by_band_;
    Eigen::MatrixXd matrix_;
    bool fluorescent_ = false;
};

} // namespace reradiant
