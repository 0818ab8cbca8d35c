#pragma once

#include "host/layers/sources/re_emission.h"

#include "kernels/core/portable.h"

#include <Eigen/Core>

#include <cmath>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

namespace reradiant {

/// A direction in air by its cosine and its side of the stack.
struct AirDirection {
    double cosine = 1.0; ///< from the normal of its own side, 0 to 1
    Side side = Side::Above;

    bool operator==(const AirDirection&) const = default;
};

/// These take a unit vector in the local frame, z = normal, apart: its side, its cosine and side,
/// and the vector itself as seen from its side.
inline Side side_of(const kernels::Vec3& w) {
    return w.z > 0.0 ? Side::Above : Side::Below;
}
inline AirDirection air_direction(const kernels::Vec3& w) {
    return {std::fabs(w.z), side_of(w)};
}
inline kernels::Vec3 mirrored_above(const kernels::Vec3& w) {
    return kernels::vec3(w.x, w.y, std::fabs(w.z));
}

/// A stack whose slabs hold dyes, at every band.
struct DyedStack {
    std::vector<StackElements> by_band; ///< to the lower face, or to a Lambertian substrate
    std::vector<Eigen::MatrixXd> slabs; ///< what dyes send out (host/layers/stack/slab_emission.h)
    Eigen::MatrixXd substrate;          ///< (bands, bands), rows = emission; empty for a sheet
};

/// Returns the depth cells of every slab: thin enough at the largest depth of all bands, none for
/// one without dyes.
StackCells stack_cells(const DyedStack& stack, int cells_per_octave);

/// Light that a stack with dyes sends out again: from the dyes in its slabs, from its substrate,
/// and from one to the other and back, to all orders.
///
/// Depth is cut into cells in which emission is uniform. The error of that falls as the square of
/// their thickness, and leading terms are taken away by comparing cells with halves of them
/// (Richardson 1911): values are (4 fine - coarse) / 3. Cells are halved until such values change
/// by no more than a tolerance.
class EmittingStack {
public:
    /// Light by where it has been: `Slab` never reached the substrate.
    enum class Part { All, Slab };
    static constexpr double tolerance = 1e-4;

    explicit EmittingStack(DyedStack stack);
    /// Takes so many cells as a stack much like this one needed, without asking for the error.
    EmittingStack(DyedStack stack, int cells_per_octave);

    Eigen::Index bands() const { return static_cast<Eigen::Index>(stack_.by_band.size()); }
    /// Returns the BSDF of this light, 1/sr without the cosine: (bands, bands), rows = emission.
    Eigen::MatrixXd value(const AirDirection& from, const AirDirection& to, Part part) const;
    /// Returns its directional-hemispherical share on a side, unit 1, likewise.
    Eigen::MatrixXd albedo(const AirDirection& from, Side to, Part part) const;
    /// Returns what is seen in a direction of light that comes from all directions of a side alike,
    /// over what a perfect diffuser in the stack's place would show, likewise: the integral of
    /// `value` over where light comes from.
    Eigen::MatrixXd diffusely_lit(Side from, const AirDirection& to, Part part) const;
    /// Returns the share that is guided for ever by total reflection, likewise.
    Eigen::MatrixXd guided(const AirDirection& from) const;

    /// Depth cells of all slabs together, the finest, and those of each octave (DepthCells).
    int cells() const;
    int cells_per_octave() const;
    /// Change of the directional-hemispherical shares with the last halving of the cells, relative
    /// to the largest: a bound of their error.
    double error() const { return error_; }
    /// True where nothing is sent out in a band below the one that excites it.
    bool shifts_up() const { return fine().shifts_up(); }
    const StackCells& fine_cells() const { return levels_.back().cells; }
    /// The series with the finest cells, and with twice as thick ones.
    const ReEmission& fine() const { return *levels_.back().all; }
    const ReEmission& coarse() const { return *(levels_.end() - 2)->all; }

private:
    struct Level {
        StackCells cells;
        std::vector<std::shared_ptr<const SourceTransport>> by_band;
        std::vector<ScatteringTransport> scattering; ///< by band
        std::shared_ptr<const ReEmission> all, slabs_alone;
    };
    /// What every source sends out, (sources, bands), by excitation, with coarse and fine cells.
    struct Sent {
        AirDirection from;
        Part part;
        std::vector<Eigen::MatrixXd> coarse, fine;
    };

    Level make_level(int cells_per_octave) const;
    void make_scattering(Level& level) const;
    Level make_coarser(const Level& fine) const;
    void make_series(Level& level) const;
    const ReEmission& series_of(const Level& level, Part part) const;
    template <typename Reached>
    std::vector<Eigen::MatrixXd> sent_by(const ReEmission& series, const Reached& reached) const;
    std::vector<Eigen::MatrixXd> sent_from(const ReEmission& series,
                                           const AirDirection& from) const;
    std::shared_ptr<const Sent> sent(const AirDirection& from, Part part) const;
    Eigen::MatrixXd probe(const Level& coarse, const Level& fine) const;
    template <typename Weigh>
    Eigen::MatrixXd extrapolated(const Sent& sent, const Weigh& weigh) const;

    DyedStack stack_;
    std::vector<Level> levels_;
    double error_ = 0.0;
    mutable std::mutex mutex_;
    mutable std::list<std::shared_ptr<const Sent>> recent_;
};

} // namespace reradiant
