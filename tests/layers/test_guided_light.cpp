#include "host/layers/walk/guided_light.h"
#include "kernels/scatter/fresnel.h"
#include "tests/layers/slab_cases.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace reradiant;

namespace {

/// Slabs of 1.5, 1.4 and 1.6 in air with these depths of absorption.
struct Pile {
    std::array<double, 3> iors{1.5, 1.4, 1.6}, depths;

    WalkElements elements() const {
        LayerStack stack{{}, LowerFace{}};
        for (std::size_t k = 0; k < iors.size(); ++k) {
            Layer& layer = stack.layers.emplace_back();
            layer.ior = Spectrum::constant(iors[k]);
            layer.absorption = Spectrum::constant(depths[k]);
        }
        return WalkMaterial(stack, {}, {550.0}, {}).at_band(0);
    }
    /// The place of slab k among them.
    static std::size_t slab(std::size_t k) { return 2 * k + 1; }
};

/// Counts events by slab and half of the slab and whether the light came down.
struct Counts {
    std::vector<double> seen = std::vector<double>(12, 0.0);

    void add(std::size_t slab, bool down, double z) {
        seen[slab * 4 + (down ? 2U : 0U) + (z > 0.5 ? 1U : 0U)] += 1.0;
    }
};

/// Passage by passage, for a ray that stands at the end of slab `k`.
void follow(const Pile& pile, std::size_t k, bool down, double n_sine, WalkRandom& random,
            Counts& counts) {
    const auto cosine = [&](std::size_t slab) {
        return std::sqrt(1.0 - std::pow(n_sine / pile.iors[slab], 2.0));
    };
    while (true) {
        const bool is_outer = down ? k == 2 : k == 0;
        const std::size_t next = is_outer ? k : down ? k + 1 : k - 1;
        const bool reflects =
            is_outer ||
            random.next() < kernels::fresnel_dielectric(cosine(k), pile.iors[next] / pile.iors[k]);
        down = reflects ? !down : down;
        k = reflects ? k : next;
        const double free = -std::log1p(-random.next()) * cosine(k) / pile.depths[k];
        if (free < 1.0)
            return counts.add(k, down, down ? free : 1.0 - free);
    }
}

} // namespace

TEST(GuidedLight, HasItsNextEventWherePassageByPassageHasIt) {
    const Pile pile{.depths = {0.02, 0.3, 1.0}};
    const WalkElements elements = pile.elements();
    const double n_sine = 1.2;
    for (const std::size_t k : {0U, 1U, 2U}) {
        for (const bool down : {true, false}) {
            const double sine = n_sine / pile.iors[k], c = std::sqrt(1.0 - sine * sine);
            const kernels::Vec3 d = kernels::vec3(0.6 * sine, -0.8 * sine, down ? -c : c);
            const auto light = GuidedLight::find(elements, Pile::slab(k), d);
            ASSERT_TRUE(light);
            WalkRandom random(1, k, down ? 1 : 0);
            Counts at_once, one_by_one;
            const int count = 40000;
            for (int walk = 0; walk < count; ++walk) {
                const auto event = light->next_event(random);
                ASSERT_TRUE(event);
                const std::size_t slab = (event->element - 1) / 2;
                EXPECT_NEAR(pile.iors[slab] * std::hypot(event->d.x, event->d.y), n_sine, 1e-12);
                EXPECT_NEAR(kernels::vec3_dot(event->d, event->d), 1.0, 1e-12);
                at_once.add(slab, event->d.z < 0.0, event->z);
                follow(pile, k, down, n_sine, random, one_by_one);
            }
            const double bound = test::sidak_bound(12.0 * 6.0);
            for (std::size_t cell = 0; cell < 12; ++cell) {
                const double a = at_once.seen[cell], b = one_by_one.seen[cell];
                EXPECT_NEAR(a, b, bound * std::sqrt(a + b + 1.0))
                    << k << " " << down << " " << cell;
            }
        }
    }
}

TEST(GuidedLight, KeepsItsChancesHoweverSeldomAnEventComes) {
    // the flux is the same everywhere, so that slabs share the events by their depth over cosine
    const Pile pile{.depths = {1e-200, 0.0, 3e-200}};
    const WalkElements elements = pile.elements();
    const double sine = 1.2 / 1.4;
    const kernels::Vec3 d = kernels::vec3(sine, 0.0, std::sqrt(1.0 - sine * sine));
    const auto light = GuidedLight::find(elements, Pile::slab(1), d);
    ASSERT_TRUE(light);
    WalkRandom random(1, 2, 3);
    double above = 0.0;
    const int count = 10000;
    for (int walk = 0; walk < count; ++walk) {
        const auto event = light->next_event(random);
        ASSERT_TRUE(event && event->element != Pile::slab(1));
        EXPECT_TRUE(event->z >= 0.0 && event->z <= 1.0);
        above += event->element == Pile::slab(0) ? 1.0 : 0.0;
    }
    const double weight_above = 1.0 / std::sqrt(1.0 - 0.8 * 0.8), // 1.2 / 1.5
        weight_below = 3.0 / std::sqrt(1.0 - 0.75 * 0.75);        // 1.2 / 1.6
    const double share = weight_above / (weight_above + weight_below);
    EXPECT_NEAR(above / count, share, 5.0 * std::sqrt(share * (1.0 - share) / count));
}

TEST(GuidedLight, IsOnlyWhereNothingLetsItGo) {
    const Pile clear{.depths = {0.0, 0.0, 0.0}};
    const auto along = [](double sine, bool up) {
        const double c = std::sqrt(1.0 - sine * sine);
        return kernels::vec3(sine, 0.0, up ? c : -c);
    };
    WalkRandom random(1, 2, 3);
    const WalkElements elements = clear.elements();
    EXPECT_FALSE(GuidedLight::find(elements, Pile::slab(0), along(0.6, true)));
    const auto light = GuidedLight::find(elements, Pile::slab(0), along(0.7, true));
    ASSERT_TRUE(light);
    EXPECT_FALSE(light->next_event(random));
    // a rough face lets it go, whatever its direction
    LayerStack rough{{{}}, LowerFace{.alpha = 0.1}};
    EXPECT_FALSE(GuidedLight::find(WalkMaterial(rough, {}, {550.0}, {}).at_band(0), Pile::slab(0),
                                   along(0.9, false)));
    // and so does a substrate, but not from above a medium that reflects all
    LayerStack varnish{{{}, {}}};
    varnish.layers[1].ior = Spectrum::constant(1.2);
    const SubstrateValues white{.matrix = Eigen::MatrixXd::Ones(1, 1)};
    const WalkElements over_white = WalkMaterial(varnish, white, {550.0}, {}).at_band(0);
    EXPECT_FALSE(GuidedLight::find(over_white, Pile::slab(0), along(0.75, false)));
    EXPECT_TRUE(GuidedLight::find(over_white, Pile::slab(0), along(0.85, false)));
    EXPECT_FALSE(GuidedLight::find(over_white, Pile::slab(1), along(0.9, false)));
}
