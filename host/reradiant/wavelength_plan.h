#pragma once

#include "reradiant/scene.h"

#include <array>
#include <string>
#include <vector>

namespace reradiant {

/// One wavelength that every path carries: a cell of the comb, or a fixed line of a lamp.
struct Lane {
    int cell = 0; ///< index in the comb
    bool is_line =
        false; ///< fixed wavelength; its radiance is integrated over the line (no "per nm")
    double line_nm = 0.0, line_width_nm = 0.0;
};

/// A `WavelengthPlan` says which wavelengths a scene is sampled at. Each of `phases` sub-cells of
/// the comb's cells is one phase; a path uses one. Narrow lines stand beside the comb as lanes of
/// their own, after the lane of the cell they lie in, so that lanes ascend in wavelength.
struct WavelengthPlan {
    WavelengthGrid film;
    WavelengthGrid comb;
    int phases = 1; ///< a power of two; 1: band centres only
    int hero = 0;   ///< wavelengths that a path samples of the lanes (kernels/stack/hero.h); 0: all
    std::vector<Lane> lanes;
    std::vector<std::string> left_out; ///< wavelengths not sampled, and why

    int padded_lanes() const; ///< whole vectors of 16
    double wavelength_nm(int lane, int phase) const;
    /// Sub-cell of a comb lane at a phase (the whole cell when there is one phase), or the line.
    std::array<double, 2> interval_nm(int lane, int phase) const;
    /// Film band a lane adds to (-1: none), the weight that turns the lane's radiance into a part
    /// of the band's mean radiance per nm, and the weight for the band above where the lane's
    /// interval reaches into it.
    struct Deposit {
        int band = -1;
        double weight = 0.0, next_weight = 0.0;
        bool operator==(const Deposit&) const = default;
    };
    Deposit deposit(int lane, int phase) const;
    /// True for a line that has lanes of its own (then it is not on the comb).
    bool stands_apart(const SpectralLine& line) const;
    /// First lane that adds to a film band at some phase, and how many do from there on.
    std::array<int, 2> seen_lanes() const;
    /// True when every lane adds to one band alone, the same whatever the phase.
    bool deposits_are_fixed() const;
};

constexpr int default_hero_wavelengths = 4, most_hero_wavelengths = 16;

struct WavelengthOptions {
    int comb_count = 0;    ///< 0: as many cells as film bands in the sampled range
    int hero_count = 0;    ///< 0: comb, else `hero` with so many, at most most_hero_wavelengths
    bool centred = false;  ///< one phase at the centres instead of random phases
    bool keep_all = false; ///< sample bands that cannot matter, too
};

/// Film bands of a scene: as given, else 300-780 by 10 when something fluoresces, 380-780 if not.
WavelengthGrid film_bands(const Scene& scene);

WavelengthPlan plan_wavelengths(const Scene& scene, const WavelengthGrid& film,
                                const WavelengthOptions& options);

} // namespace reradiant
