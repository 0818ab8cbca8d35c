// layer_stack_sample against layer_stack_pdf, compiled in double, over the tables that the kernels
// get: chi-square over half vectors.
#include "host/render/tables/scene_tables.h"
#include "kernels/stack/layer_stack.h"
#include "tests/render/test_scenes.h"
#include "tests/support/directions.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace reradiant {
namespace {

using namespace test;
using kernels::LayerChoice;
using kernels::LayerStackView;
using kernels::Vec3;
using kernels::vec3;

/// A material's tables, made for the number of deeper lobes that this program was compiled with.
class Tabulated {
public:
    Tabulated(const Material& material, Model model) {
        Scene scene = plane_scene(material, 0.0, 1, 1);
        scene.lights = {environment(Spectrum::constant(1.0))};
        WavelengthOptions options;
        options.centred = true;
        const WavelengthPlan plan =
            plan_wavelengths(scene, grid_from_range(450, 650, 100), options);
        RenderFeatures features; // as kernels are compiled here
        features.lobes = LOBES;
        features.sheets = FEATURE_SHEETS != 0;
        append_material(material, plan_material(material, {model, ""}, plan), plan, features,
                        MaterialOptics(material, model, plan), tables_);
        const MaterialRecord& record = tables_.materials.front();
        view_ = {record, tables_.layers.data(), tables_.lobes.data(), tables_.tables.data()};
    }
    const LayerStackView& view() const { return view_; }

    /// Width of the narrowest lobe: the scale of the cells.
    double narrowest() const {
        double alpha = view_.record.has_top_lobe ? tables_.layers.front().alpha : 1.0;
        for (const LobeRecord& lobe : tables_.lobes)
            if (lobe.slab == NO_INDEX)
                alpha = std::min(alpha, static_cast<double>(lobe.alpha));
        return alpha;
    }

private:
    SceneTables tables_;
    LayerStackView view_{};
};

constexpr int side = 10;             ///< cells along each slope
constexpr double reach = 4.0;        ///< extent of the cells, in widths of the narrowest lobe
constexpr int outside = side * side; ///< or below the surface, or in a cell that reaches there
constexpr int mirror = outside + 1;
constexpr int cells = mirror + 1;

/// Cells over the slopes x, y of the half vector, for one direction wo.
class SlopeCells {
public:
    SlopeCells(const Vec3& wo, double alpha) : wo_(wo), width_(2.0 * reach * alpha / side) {}

    int of(const Vec3& wi) const {
        const Vec3 h = kernels::vec3_add(wo_, wi);
        const double x = h.x / h.z / width_ + 0.5 * side, y = h.y / h.z / width_ + 0.5 * side;
        if (!(wi.z > 0.0) || !(x >= 0.0) || !(x < side) || !(y >= 0.0) || !(y < side))
            return outside;
        const int i = static_cast<int>(x), j = static_cast<int>(y);
        return is_whole(i, j) ? i * side + j : outside;
    }

    /// Directions above the surface fill a disk of slopes: a cell lies in it when its corners do.
    bool is_whole(int i, int j) const {
        const double tangent = wo_.x / wo_.z;
        for (const int a : {0, 1})
            for (const int b : {0, 1}) {
                const double x = slope(i + a), y = slope(j + b);
                if (x * x + y * y - 2.0 * tangent * x >= 1.0)
                    return false;
            }
        return true;
    }

    double slope(double cell) const { return (cell - 0.5 * side) * width_; }
    double width() const { return width_; }

private:
    Vec3 wo_; ///< y = 0
    double width_;
};

std::vector<double> sampled(const LayerStackView& view, const Vec3& wo, double alpha, int count) {
    const LayerChoice choice = kernels::layer_stack_choice(view, wo.z);
    const SlopeCells slopes(wo, alpha);
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> seen(cells, 0.0);
    for (int i = 0; i < count; ++i) {
        int is_delta = 0;
        const double u0 = uniform(engine), u1 = uniform(engine), u2 = uniform(engine);
        const Vec3 wi = kernels::layer_stack_sample(view, &choice, wo, u0, u1, u2, &is_delta);
        seen[static_cast<std::size_t>(is_delta ? mirror : slopes.of(wi))] += 1.0;
    }
    return seen;
}

/// Integral of the pdf over a cell by the midpoint rule: d wi = 4 (wo.h) cos^3 dx dy.
double cell_share(const LayerStackView& view, const LayerChoice& choice, const Vec3& wo,
                  const SlopeCells& slopes, int i, int j) {
    constexpr int fine = 12;
    const double step = slopes.width() / fine;
    double share = 0.0;
    for (int a = 0; a < fine; ++a)
        for (int b = 0; b < fine; ++b) {
            const Vec3 h = kernels::vec3_normalise(
                vec3(slopes.slope(i + (a + 0.5) / fine), slopes.slope(j + (b + 0.5) / fine), 1.0));
            const double cos_h = kernels::vec3_dot(wo, h);
            const Vec3 wi = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wo);
            share += kernels::layer_stack_pdf(view, &choice, wo, wi) * 4.0 * cos_h * h.z * h.z *
                     h.z * step * step;
        }
    return share;
}

std::vector<double> expected(const LayerStackView& view, const Vec3& wo, double alpha) {
    const LayerChoice choice = kernels::layer_stack_choice(view, wo.z);
    const SlopeCells slopes(wo, alpha);
    std::vector<double> shares(cells, 0.0);
    shares[mirror] = kernels::layer_stack_probability(&choice, CHOICE_DELTA);
    shares[outside] = 1.0 - shares[mirror];
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            if (!slopes.is_whole(i, j))
                continue;
            const double share = cell_share(view, choice, wo, slopes, i, j);
            const int cell = i * side + j;
            shares[static_cast<std::size_t>(cell)] = share;
            shares[outside] -= share;
        }
    return shares;
}

/// Returns how far counts are from their shares, in standard deviations of a chi-square.
double share_sigmas(const std::vector<double>& seen, const std::vector<double>& shares, int count) {
    std::vector<double> expected;
    for (const double share : shares)
        expected.push_back(share * count);
    return chi_square_sigmas(seen, expected, true);
}

Conductor metal(double alpha) {
    Conductor conductor;
    conductor.ior = Spectrum::constant(0.3);
    conductor.kappa = Spectrum::constant(3.0);
    conductor.alpha = alpha;
    return conductor;
}

Material on_metal(std::vector<Layer> layers, const Conductor& conductor) {
    Material m = material(std::move(layers), 0.0);
    m.substrate.type = SubstrateType::Conductor;
    m.substrate.conductor = conductor;
    return m;
}

struct Case {
    const char* what;
    Material material;
    Model model;
};

std::vector<Case> sampling_cases() {
    std::vector<Case> cases;
    for (const Distribution distribution :
         {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn})
        for (const double degrees : {0.5, 10.0, 40.0}) {
            Layer top = layer(1.5, alpha_from_roughness_deg(distribution, degrees), 0.2);
            top.distribution = distribution;
            cases.push_back({"top", material({top}, 0.3), Model::WeidlichWilkie});
        }
    cases.push_back(
        {"adding, two lobes", material({layer(1.3, 0.2), layer(1.6, 0.3)}, 0.5), Model::Adding});
    cases.push_back(
        {"delta over rough", material({layer(1.3), layer(1.6, 0.2)}, 0.5), Model::WeidlichWilkie});
    cases.push_back({"metal", on_metal({}, metal(0.1)), Model::WeidlichWilkie});
    cases.push_back({"lacquered metal", on_metal({layer(1.5)}, metal(0.2)), Model::WeidlichWilkie});
    Layer paint = layer(1.5, 0.3, 0.1);
    paint.flakes = Flakes{0.4, metal(0.1)};
    paint.scattering_coefficient = Spectrum::constant(0.5);
    cases.push_back({"flakes in a scattering slab", material({paint}, 0.3), Model::WeidlichWilkie});
    return cases;
}

constexpr double thetas[] = {0.0, 30.0, 60.0, 85.0, 89.0};

TEST(Sampling, DirectionsFollowThePdfOfEveryComponent) {
    // A width that is 1 % off shows at 2e6 samples (see the mutant), one that is 5 % off at 1e5.
    const int count = test::is_full_run() ? 2000000 : 100000;
    const std::vector<Case> cases = sampling_cases();
    const double bound = test::sidak_bound(static_cast<int>(cases.size() * std::size(thetas)));
    for (const Case& one : cases) {
        const Tabulated tables(one.material, one.model);
        const double alpha = tables.narrowest();
        for (const double theta : thetas) {
            const Vec3 wo = vec3(std::sin(radians(theta)), 0.0, std::cos(radians(theta)));
            const double sigmas = share_sigmas(sampled(tables.view(), wo, alpha, count),
                                               expected(tables.view(), wo, alpha), count);
            EXPECT_LT(sigmas, bound) << one.what << ", alpha " << alpha << ", theta " << theta;
        }
    }
}

TEST(Sampling, AWidthThatIsOnePercentOffFailsTheTest) {
    const auto with_alpha = [](double alpha) {
        return Tabulated(material({layer(1.5, alpha)}, 0.0), Model::WeidlichWilkie);
    };
    const Tabulated right = with_alpha(0.2), wrong = with_alpha(0.202);
    constexpr int count = 2000000;
    const Vec3 wo = vec3(0.6, 0.0, 0.8);
    const std::vector<double> shares = expected(right.view(), wo, 0.2);
    EXPECT_LT(share_sigmas(sampled(right.view(), wo, 0.2, count), shares, count),
              test::sidak_bound(1));
    EXPECT_GT(share_sigmas(sampled(wrong.view(), wo, 0.2, count), shares, count),
              test::sidak_bound(1));
}

TEST(Sampling, NoDirectionThatCarriesLightHasProbabilityZero) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (const Case& one : sampling_cases()) {
        const Tabulated tables(one.material, one.model);
        for (int i = 0; i < 2000; ++i) {
            const auto direction = [&] {
                const double c = 1e-4 + (1.0 - 1e-4) * uniform(engine);
                const double s = std::sqrt((1.0 - c) * (1.0 + c));
                const double phi = 2.0 * std::numbers::pi * uniform(engine);
                return vec3(s * std::cos(phi), s * std::sin(phi), c);
            };
            const Vec3 wo = direction(), wi = direction();
            const LayerChoice choice = kernels::layer_stack_choice(tables.view(), wo.z);
            EXPECT_GT(kernels::layer_stack_pdf(tables.view(), &choice, wo, wi), 0.0) << one.what;
        }
    }
}

} // namespace
} // namespace reradiant
