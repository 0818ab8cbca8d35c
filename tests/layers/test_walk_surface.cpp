#include "host/layers/walk/walk_surface.h"
#include "tests/layers/layer_values.h"
#include "tests/support/full_run.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace reradiant;

namespace {

/// Regions of the directions of one side: three rings of equal depth by two halves.
constexpr int rings = 3, halves = 2, regions = 2 * rings * halves;

int region_of(bool same_side, const kernels::Vec3& w) {
    const int ring = std::min(static_cast<int>(w.z * rings), rings - 1);
    return ((same_side ? 0 : 1) * rings + ring) * halves + (w.x > 0.0 ? 0 : 1);
}
kernels::Vec3 direction_in(int region, double u1, double u2) {
    const int ring = region / halves % rings;
    const double c = (ring + u1) / rings, s = std::sqrt((1.0 - c) * (1.0 + c));
    const double phi = M_PI * (u2 - 0.5 + (region % halves == 0 ? 0.0 : 1.0));
    return kernels::vec3(s * std::cos(phi), s * std::sin(phi), c);
}

struct Mean {
    double sum = 0.0, squares = 0.0;
    void add(double x) {
        sum += x;
        squares += x * x;
    }
    double value(int n) const { return sum / n; }
    double error2(int n) const { return std::max(squares / n - value(n) * value(n), 0.0) / n; }
};

/// Flux by region: from where the walk goes on, and from the values asked for in directions drawn
/// evenly from each region.
struct Fluxes {
    std::array<Mean, regions> sampled, valued;
};
Fluxes measure(const WalkSurface& surface, bool from_below, double theta, int count) {
    Fluxes fluxes;
    const kernels::Vec3 v = kernels::vec3(-std::sin(theta), 0.0, std::cos(theta));
    WalkRandom random(17, 0, 0);
    const double solid_angle = 2.0 * M_PI / (rings * halves);
    for (int k = 0; k < count; ++k) {
        std::vector<SurfaceTarget> targets;
        for (int region = 0; region < regions; ++region) {
            const double u1 = random.next(), u2 = random.next();
            targets.push_back({region < regions / 2, direction_in(region, u1, u2)});
        }
        const SurfaceEvent event = meet_rough_surface(surface, from_below, v, targets, random);
        const int to = event.weight > 0.0 ? region_of(event.same_side, event.w) : -1;
        for (int region = 0; region < regions; ++region) {
            const SurfaceTarget& target = targets[static_cast<std::size_t>(region)];
            fluxes.sampled[static_cast<std::size_t>(region)].add(to == region ? event.weight : 0.0);
            fluxes.valued[static_cast<std::size_t>(region)].add(target.value * target.w.z *
                                                                solid_angle);
        }
    }
    return fluxes;
}

WalkSurface interface_surface(const LayerValues& layer) {
    return walk_surface(*surface_of(stack_of({layer}).front()));
}

/// Every distribution and scattering of an interface and of a metal.
std::vector<WalkSurface> surfaces() {
    std::vector<WalkSurface> all;
    for (const Distribution distribution :
         {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn}) {
        for (const Scattering scattering : {Scattering::Multiple, Scattering::Single}) {
            for (const double alpha : {0.2, 0.6}) {
                all.push_back(interface_surface({1.5, distribution, alpha, scattering}));
                SurfaceValues metal = conductor_values(0.2, 3.0, distribution, alpha, scattering);
                metal.ior_above = 1.3;
                all.push_back(walk_surface(metal));
            }
        }
    }
    LayerValues filmed{1.8, Distribution::Ggx, 0.4, Scattering::Multiple};
    filmed.film = {250.0, 1.4};
    filmed.wavelength_nm = 500.0;
    all.push_back(interface_surface(filmed));
    return all;
}

} // namespace

TEST(WalkSurface, ValuesAreWhatIsSampled) {
    const int count = test::is_full_run() ? 200000 : 8000;
    const std::vector<WalkSurface> all = surfaces();
    // at 8000 draws a region that holds a tenth of the flux is known to some 5 %
    const double bound = test::sidak_bound(static_cast<double>(all.size()) * 2 * 2 * regions);
    for (std::size_t k = 0; k < all.size(); ++k) {
        for (const bool from_below : {false, true}) {
            for (const double theta : {0.4, 1.2}) {
                const Fluxes fluxes = measure(all[k], from_below, theta, count);
                for (std::size_t region = 0; region < regions; ++region) {
                    const Mean &a = fluxes.sampled[region], &b = fluxes.valued[region];
                    // a region that holds next to nothing may have been met by nobody
                    const double rare = 1e-12 + 20.0 / count;
                    EXPECT_NEAR(a.value(count), b.value(count),
                                bound * std::sqrt(a.error2(count) + b.error2(count)) +
                                    (b.value(count) < rare ? rare : 0.0))
                        << "surface " << k << (from_below ? " below " : " above ") << theta
                        << " region " << region;
                }
            }
        }
    }
}

TEST(WalkSurface, RefractionHasTheSameValueBothWaysOverTheSquareOfTheIndex) {
    const kernels::Vec3 above = kernels::vec3(0.6, 0.0, 0.8);
    for (const Distribution distribution :
         {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn}) {
        for (const Scattering scattering : {Scattering::Single, Scattering::Multiple}) {
            const WalkSurface surface = interface_surface({1.5, distribution, 0.3, scattering});
            const kernels::Vec3 below = kernels::vec3_normalise(kernels::vec3(0.55, 0.1, 0.85));
            Mean down, up;
            const int count = 20000;
            WalkRandom random(5, 0, 0);
            for (int k = 0; k < count; ++k) {
                std::array<SurfaceTarget, 1> target{{{false, below}}};
                meet_rough_surface(surface, false, above, target, random);
                down.add(target[0].value / 2.25);
                target = {{{false, above}}};
                meet_rough_surface(surface, true, below, target, random);
                up.add(target[0].value);
            }
            EXPECT_GT(down.value(count), 0.05);
            EXPECT_NEAR(down.value(count), up.value(count),
                        test::sidak_bound(6) * std::sqrt(down.error2(count) + up.error2(count)) +
                            1e-12);
        }
    }
}

TEST(WalkSurface, Case13EqualMediaDoNothing) {
    const WalkSurface surface = interface_surface({1.00004, Distribution::Ggx, 0.5});
    EXPECT_FALSE(surface.is_rough());
    WalkRandom random(1, 0, 0);
    const kernels::Vec3 v = kernels::vec3(0.6, 0.0, 0.8);
    const WalkSurface equal = interface_surface({1.0, Distribution::Ggx, 0.5});
    const SurfaceEvent event = meet_smooth_surface(equal, false, v, random);
    EXPECT_FALSE(event.same_side);
    EXPECT_EQ(event.weight, 1.0);
    EXPECT_EQ(event.w.x, v.x);
    EXPECT_EQ(event.w.z, v.z);
}
