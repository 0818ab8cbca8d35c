#pragma once

#include "kernels/core/portable.h"
#include "reradiant/layer_stack.h"

#include <array>
#include <vector>

namespace reradiant {

/// A rough interface between a thinner medium above (IOR 1) and a denser one below (eta >= 1).
struct RoughInterface {
    double eta = 1.5;
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.1;
    Scattering scattering = Scattering::Multiple;

    bool operator==(const RoughInterface&) const = default;
};

/// A rank-1 lattice rule of Korobov's form: `count` points, generator vector 1, g, g^2, ...
struct LatticeRule {
    unsigned count, generator;
};
/// The rule that an interface's operator is sampled with: more points where a walk is one event.
LatticeRule lattice_rule(const RoughInterface& interface);

/// A lattice rule shifted by offsets hashed from `seed`.
struct WalkStream {
    static constexpr unsigned dimensions = 12;
    WalkStream(const LatticeRule& rule, unsigned seed);

    unsigned seed;
    std::array<double, dimensions> generator{}, shift{};
};

/// Uniform numbers of one walk: the first ones from the stream's lattice, the rest from a hash of
/// (walk, seed, dimension). Counter-based: nothing depends on the order in which walks are run.
class WalkNumbers {
public:
    WalkNumbers(const WalkStream& stream, unsigned walk) : stream_(stream), walk_(walk) {}
    double next();

private:
    const WalkStream& stream_;
    unsigned walk_;
    unsigned dimension_ = 0;
};

/// A share of the incident flux that leaves an interface.
struct Departure {
    bool same_side; ///< reflected
    double cosine;  ///< on the side where it leaves
    double share;
};

/// Scatters light that comes at `cosine` from above (or from below) and collects departures, whose
/// shares have the directional-hemispherical values as expectation; returns the share of the
/// single-scattering reflection lobe F D G2 / (4 ci co) in it.
/// `single` (and blinn): Walter et al. 2007 with G2 = 1 / (1 + Lambda_i + Lambda_o) (blinn: the
/// V-cavity's G) for reflection and refraction; what is masked is lost.
/// `multiple` (ggx, beckmann): random walk on the Smith microsurface (Heitz, Hanika, d'Eon and
/// Dachsbacher 2016, sections 4 to 6), heights uncorrelated with slopes, refraction included. At
/// every facet the expected departures of both branches are scored; the walk goes on with the rest.
double scatter_at_interface(const RoughInterface& interface, bool from_below, double cosine,
                            WalkNumbers& numbers, std::vector<Departure>& departures);

} // namespace reradiant
