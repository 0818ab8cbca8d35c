// The triple eval, sample, pdf of layered materials: chi-square of directions over half vectors,
// and reflectances found by sampling against those of the goniophotometer.
#include "host/layers/models/adding.h"
#include "host/layers/models/layered_bsdf.h"
#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/layers/stack/directions.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "tests/layers/layer_values.h"
#include "tests/support/full_run.h"
#include "tests/support/private_cache.h"
#include "tests/support/statistics.h"

#include <Eigen/Core>
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace reradiant;
using kernels::Vec3;

namespace {

const test::PrivateCache cache("layered-bsdf");
const WavelengthGrid one{550, 10, 1};

Vec3 at_degrees(double theta) {
    return direction_at(std::cos(theta * M_PI / 180.0), 0.0);
}

Layer layer(double ior, double alpha, Distribution distribution) {
    Layer made;
    made.ior = Spectrum::constant(ior);
    made.alpha = alpha;
    made.distribution = distribution;
    made.scattering = Scattering::Single; // the operators of `multiple` take a second each
    return made;
}
SubstrateValues grey(double reflectance, double sigma = 0.0) {
    SubstrateValues substrate;
    substrate.matrix = Eigen::MatrixXd::Constant(1, 1, reflectance);
    substrate.sigma = sigma;
    return substrate;
}
SubstrateValues metal(double alpha, Distribution distribution = Distribution::Ggx) {
    SubstrateValues substrate;
    substrate.conductor = {conductor_values(0.3, 3.0, distribution, alpha)};
    return substrate;
}

/// Cells over the half vector: rings that follow a lobe of width alpha and go on to the horizon.
class HalfVectorCells {
public:
    explicit HalfVectorCells(double alpha) {
        for (const double t : {0.0, 0.3, 0.6, 0.9, 1.3, 2.0, 3.5})
            edges_.push_back(std::atan(t * alpha));
        const double last = edges_.back();
        for (int k = 1; k <= 6; ++k)
            edges_.push_back(last + (0.5 * M_PI - last) * k / 6);
    }
    std::size_t count() const { return (edges_.size() - 1) * sectors; }

    std::size_t cell_of(const Vec3& w, const Vec3& other) const {
        const Vec3 h = kernels::vec3_normalise(kernels::vec3_add(w, other));
        const double theta = std::atan2(std::hypot(h.x, h.y), h.z);
        const auto ring = static_cast<std::size_t>(
            std::upper_bound(edges_.begin() + 1, edges_.end() - 1, theta) - edges_.begin() - 1);
        const double turn = std::atan2(h.y, h.x) / (2.0 * M_PI) + 0.5;
        return ring * sectors +
               std::min<std::size_t>(sectors - 1, static_cast<std::size_t>(turn * sectors));
    }

    /// The pdf's integral over each cell by the midpoint rule, fine enough for 1e-3 of a cell.
    std::vector<double> probabilities(const LayeredBsdf& bsdf, const Vec3& w) const {
        constexpr int fine = 40;
        std::vector<double> sums(count(), 0.0);
        for (std::size_t ring = 0; ring + 1 < edges_.size(); ++ring) {
            const double width = (edges_[ring + 1] - edges_[ring]) / fine;
            for (int a = 0; a < fine; ++a) {
                const double theta = edges_[ring] + (a + 0.5) * width;
                for (std::size_t b = 0; b < sectors * fine; ++b) {
                    const double phi =
                        2.0 * M_PI * ((static_cast<double>(b) + 0.5) / (sectors * fine) - 0.5);
                    const Vec3 h = direction_at(std::cos(theta), phi);
                    const double c = kernels::vec3_dot(w, h);
                    const Vec3 other = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * c), w);
                    if (c > 0.0 && other.z > 0.0) {
                        sums[ring * sectors + b / fine] += bsdf.pdf(w, other) * 4.0 * c *
                                                           std::sin(theta) * width * 2.0 * M_PI /
                                                           (sectors * fine);
                    }
                }
            }
        }
        return sums;
    }

private:
    static constexpr std::size_t sectors = 8;
    std::vector<double> edges_;
};

/// Returns how often `drawn` finds each cell; empty when it finds a direction where the pdf of
/// `claimed` is 0.
std::vector<double> found_cells(const LayeredBsdf& drawn, const LayeredBsdf& claimed, const Vec3& w,
                                const HalfVectorCells& cells, int count) {
    std::vector<double> seen(cells.count(), 0.0);
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < count; ++i) {
        const double u0 = uniform(generator), u1 = uniform(generator), u2 = uniform(generator);
        const LayeredBsdf::Sample sample = drawn.sample(w, {u0, u1, u2});
        if (sample.is_delta || sample.w.z <= 0.0)
            continue;
        if (!(claimed.pdf(w, sample.w) > 0.0))
            return {};
        seen[cells.cell_of(w, sample.w)] += 1.0;
    }
    return seen;
}

/// Returns how far the directions that `drawn` samples are from what the pdf of `claimed` says, in
/// standard deviations of a chi-square above its mean; infinite for a
/// direction where the pdf is 0. `jacobian` is a
/// factor that the pdf ought not to have.
double chi_square_sigmas(const LayeredBsdf& drawn, const LayeredBsdf& claimed, double theta,
                         double alpha, int count, double jacobian = 1.0) {
    const HalfVectorCells cells(alpha);
    const Vec3 w = at_degrees(theta);
    const std::vector<double> seen = found_cells(drawn, claimed, w, cells, count);
    if (seen.empty())
        return INFINITY;
    const std::vector<double> shares = cells.probabilities(claimed, w);
    std::vector<double> expected;
    for (const double share : shares)
        expected.push_back(jacobian * share * count);
    return test::chi_square_sigmas(seen, expected, false);
}

struct Case {
    std::string name;
    double alpha;
    LayeredBsdf bsdf;
};

/// Both models over every distribution, 0.5 to 40 degrees; a rough layer over grey, a rough metal
/// under a smooth layer, and two rough layers.
std::vector<Case> sampling_cases() {
    std::vector<Case> cases;
    for (const Distribution d : {Distribution::Blinn, Distribution::Beckmann, Distribution::Ggx}) {
        for (const double degrees : {0.5, 10.0, 40.0}) {
            const double alpha = alpha_from_roughness_deg(d, degrees);
            const std::string name = fmt::format("{} of {} degrees", static_cast<int>(d), degrees);
            const LayerStack rough{{layer(1.5, alpha, d)}};
            const LayerStack two{{layer(1.5, alpha, d), layer(1.3, 0.3, d)}};
            const LayerStack smooth{{layer(1.5, 0.0, d)}};
            if (d != Distribution::Blinn || degrees == 10.0)
                cases.push_back({name + ", adding", alpha, {rough, grey(0.5), one, adding_bsdf}});
            cases.push_back({name + ", weidlich-wilkie",
                             alpha,
                             {two, grey(0.2, 0.4), one, weidlich_wilkie_bsdf}});
            cases.push_back({name + ", metal",
                             std::min(1.0, 1.5 * alpha),
                             {smooth, metal(alpha, d), one, weidlich_wilkie_bsdf}});
        }
    }
    return cases;
}

/// Reflectance for light from theta found by sampling, with its standard error.
std::array<double, 2> sampled_albedo(const LayeredBsdf& bsdf, double theta, int count) {
    const Vec3 w = at_degrees(theta);
    std::mt19937_64 generator(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < count; ++i) {
        const double u0 = uniform(generator), u1 = uniform(generator), u2 = uniform(generator);
        const LayeredBsdf::Sample sample = bsdf.sample(w, {u0, u1, u2});
        double value = 0.0;
        const bool is_back = (sample.w.z > 0.0) == (w.z > 0.0);
        const double c = std::fabs(w.z);
        if (sample.is_delta && is_back)
            value = bsdf.delta(c, w.z > 0.0 ? Side::Above : Side::Below).sum() / sample.pdf;
        else if (sample.is_delta)
            value = bsdf.straight_on(c).sum() / sample.pdf;
        else if (sample.pdf > 0.0)
            value = bsdf.eval(w, sample.w).sum() * std::fabs(sample.w.z) / sample.pdf;
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

} // namespace

TEST(LayeredBsdf, SamplesFollowTheirPdf) {
    // 4 % of a lobe's width are seen in a normal run, 1.3 % in a full one
    const int count = test::is_full_run() ? 500000 : 50000;
    const std::vector<Case> cases = sampling_cases();
    const double bound = test::sidak_bound(static_cast<int>(cases.size()) * 4);
    for (const Case& one_case : cases) {
        for (const double theta : {0.0, 45.0, 75.0, 89.0}) {
            EXPECT_LT(chi_square_sigmas(one_case.bsdf, one_case.bsdf, theta, one_case.alpha, count),
                      bound)
                << one_case.name << " theta " << theta;
        }
    }
}

TEST(LayeredBsdf, AWidthOrAJacobianThatIsOnePercentOffFailsTheTest) {
    const LayeredBsdf right({}, metal(0.2), one, weidlich_wilkie_bsdf);
    const LayeredBsdf wrong({}, metal(0.202), one, weidlich_wilkie_bsdf);
    const double bound = test::sidak_bound(1);
    const int count = 3000000;
    EXPECT_LT(chi_square_sigmas(right, right, 45.0, 0.2, count), bound);
    EXPECT_GT(chi_square_sigmas(wrong, right, 45.0, 0.2, count), bound);
    EXPECT_GT(chi_square_sigmas(right, right, 45.0, 0.2, count, 1.01), bound);
}

TEST(LayeredBsdf, SampledAlbedoIsTheHemisphericalMeasure) {
    Layer milky = layer(1.5, 0.2, Distribution::Ggx);
    milky.scattering_coefficient = Spectrum::constant(0.5);
    milky.anisotropy = 0.4;
    Layer flaked = layer(1.5, 0.0, Distribution::Ggx);
    flaked.flakes = Flakes{0.4, {}};
    flaked.flakes->reflector.kappa = Spectrum::constant(3.0);
    flaked.flakes->reflector.alpha = 0.2;
    struct Material {
        LayerStack stack;
        SubstrateValues substrate;
        Model model;
    };
    const std::vector<Material> materials{
        {{{layer(1.5, 0.3, Distribution::Ggx)}}, grey(0.7, 0.3), Model::Adding},
        {{{layer(1.5, 0.0, Distribution::Ggx)}}, grey(0.7), Model::Adding},
        {{{milky}}, grey(0.5), Model::Adding},
        {{{milky}}, grey(0.5, 0.3), Model::WeidlichWilkie},
        {{{flaked}}, grey(0.1), Model::WeidlichWilkie},
        {{}, metal(0.6), Model::WeidlichWilkie},
        {{{layer(1.5, 0.05, Distribution::Blinn)}}, metal(0.0), Model::WeidlichWilkie},
        {{{layer(1.4, 0.2, Distribution::Beckmann)}}, metal(0.3), Model::WeidlichWilkie},
    };
    const double bound = test::sidak_bound(static_cast<int>(materials.size()) * 3);
    for (std::size_t k = 0; k < materials.size(); ++k) {
        const auto& [stack, substrate, model] = materials[k];
        const LayeredBsdf bsdf(stack, substrate, one, closed_model(model));
        MeasureRequest request;
        request.model = model;
        request.hemispherical = true;
        for (const double theta : {0.0, 50.0, 85.0}) {
            request.theta_i_deg = {theta};
            double albedo = 0.0;
            for (const MeasureRow& row : measure_substrate(stack, substrate, one, request).rows)
                albedo += row.value;
            const auto [mean, error] =
                sampled_albedo(bsdf, theta, test::is_full_run() ? 1000000 : 20000);
            // 1e-4 for the quadrature of the measure, 1e-3 for the lobes' fits in adding
            const double margin = model == Model::Adding ? 1e-3 : 1e-4;
            EXPECT_NEAR(mean, albedo, bound * error + margin) << k << " theta " << theta;
            EXPECT_LT(error, 0.02) << k; // nothing escapes the lobes
        }
    }
}

TEST(LayeredBsdf, SampledLightOfASheetLeavesOnBothSides) {
    Layer milky = layer(1.5, 0.0, Distribution::Ggx);
    milky.scattering_coefficient = Spectrum::constant(0.7);
    milky.absorption = Spectrum::constant(0.1);
    const auto sheet = [](const Layer& slab, double alpha_below) {
        return LayerStack{{slab},
                          LowerFace{.alpha = alpha_below, .scattering = Scattering::Single}};
    };
    const std::vector<LayerStack> sheets{sheet(layer(1.5, 0.0, Distribution::Ggx), 0.0),
                                         sheet(layer(1.5, 0.3, Distribution::Ggx), 0.15),
                                         sheet(milky, 0.0), sheet(milky, 0.2)};
    const double bound = test::sidak_bound(static_cast<int>(sheets.size()) * 4);
    const int count = test::is_full_run() ? 1000000 : 20000;
    for (std::size_t k = 0; k < sheets.size(); ++k) {
        const LayeredBsdf bsdf(sheets[k], {}, one, adding_bsdf);
        for (const double theta : {0.0, 50.0, 85.0, 130.0}) {
            const AirDirection from{std::fabs(std::cos(theta * M_PI / 180.0)),
                                    theta < 90.0 ? Side::Above : Side::Below};
            double expected = 0.0;
            for (const Side to : {Side::Above, Side::Below}) {
                const LayeredBsdf::Parts parts = bsdf.albedo(from, to);
                expected += parts.slab.sum() + parts.specular.sum();
            }
            const auto [mean, error] = sampled_albedo(bsdf, theta, count);
            EXPECT_NEAR(mean, expected, bound * error + 2e-3) << k << " theta " << theta;
            EXPECT_LT(error, 0.02) << k;
        }
    }
}

TEST(LayeredBsdf, EvalIsWhatTheGoniophotometerSees) {
    Eigen::MatrixXd shift(2, 2);
    shift << 0.4, 0.0, 0.3, 0.6;
    SubstrateValues substrate;
    substrate.matrix = shift;
    const WavelengthGrid two{400, 100, 2};
    const LayerStack stack{{layer(1.5, 0.3, Distribution::Ggx)}};
    for (const Model model : {Model::Adding, Model::WeidlichWilkie}) {
        const LayeredBsdf bsdf(stack, substrate, two, closed_model(model));
        MeasureRequest request;
        request.model = model;
        request.theta_i_deg = {40};
        request.theta_o_deg = {25};
        request.phi_deg = {150};
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, 2);
        for (const MeasureRow& row : measure_substrate(stack, substrate, two, request).rows)
            expected(row.lambda_o_nm > 450, row.lambda_i_nm > 450) += row.value;
        const Vec3 wo = direction_at(std::cos(25 * M_PI / 180), 150 * M_PI / 180);
        EXPECT_LT((bsdf.eval(at_degrees(40), wo) - expected).norm(), 1e-14);
        EXPECT_EQ(bsdf.eval(at_degrees(40), kernels::vec3(0, 0.6, -0.8)).norm(), 0.0);
        EXPECT_EQ(bsdf.pdf(at_degrees(40), kernels::vec3(0, 0.6, -0.8)), 0.0);
    }
}

TEST(LayeredBsdf, OnlyClosedModelsHaveIt) {
    EXPECT_THROW(closed_model(Model::Walk), Error);
    EXPECT_THROW(LayeredBsdf({}, metal(0.1), one, adding_bsdf), Error);
}
