#pragma once

#include "host/layers/stack/substrate_values.h"
#include "host/layers/walk/walk_surface.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <algorithm>
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
    /// Slab with dyes: their depth at this band, and that of the events at which they take light up
    /// to send it out again. Of a material that light runs through backwards the latter may be
    /// more.
    double tau_dyes = 0.0, tau_emission = 0.0;
    /// Slab with dyes: what they send out in each band, times tau_emission; else without entries.
    Eigen::VectorXd emission{};
    double coverage = 0.0; ///< flakes
    double sigma = 0.0;    ///< diffuse

    bool is_dyed() const { return emission.size() > 0; }
    /// True for a slab that may send light in all directions.
    bool spreads() const { return tau_scattering > 0.0 || is_dyed(); }
    /// Depth of such events on a way of `length` slabs' thicknesses. A walk that passes more of
    /// them than there is absorption gains weight; it is not to gain more than 1/8 on one way.
    double tau_emission_on(double length) const {
        return std::max(tau_dyes, std::min(tau_emission, 0.125 / length));
    }
};
using WalkElements = std::vector<WalkElement>;

/// A material as lists of elements.
class WalkMaterial {
public:
    /// `emissions`: slab_emissions, or nothing where none holds a dye. A sheet has no
    /// substrate; its `substrate` is not looked at.
    WalkMaterial(const LayerStack& stack, const SubstrateValues& substrate,
                 const std::vector<double>& wavelengths_nm,
                 const std::vector<Eigen::MatrixXd>& emissions);
    /// One band, over a diffuse substrate that sends all light back. Dyes send nothing.
    explicit WalkMaterial(const StackElements& stack);

    int bands() const { return static_cast<int>(by_band_.size()); }
    /// True when all bands go the same ways: they differ in absorption and re-radiation alone.
    bool serves_all_bands() const { return !shared_.empty(); }
    bool is_sheet() const { return is_sheet_; }
    bool is_dyed() const { return is_dyed_; }
    /// True when light that reached the substrate may leave in another band than it came in.
    bool is_fluorescent() const { return fluorescent_; }
    const Eigen::MatrixXd& matrix() const { return matrix_; }

    const WalkElements& shared() const { return shared_; }
    const WalkElements& at_band(int band) const { return by_band_[static_cast<std::size_t>(band)]; }
    WalkMaterial reversed() const;

private:
    void share_elements(const std::vector<StackElements>& values);

    WalkElements shared_; ///< with the absorption of all bands; empty: they go different ways
    std::vector<WalkElements> by_band_;
    Eigen::MatrixXd matrix_;
    bool fluorescent_ = false, is_dyed_ = false, is_sheet_ = false;
};

} // namespace reradiant
