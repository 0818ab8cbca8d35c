#include "host/layers/models/effective_matrix.h"
#include "host/render/tables/substrate_operator.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace reradiant {
namespace {

using namespace test;

/// Dyes of any Stokes shift, narrow and wide, some absorbing far into their own emission.
std::vector<Fluorophore> random_dyes(std::mt19937& generator, int count) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(generator);
    };
    std::vector<Fluorophore> dyes;
    for (int k = 0; k < count; ++k) {
        const double peak = between(330, 600);
        dyes.push_back({Spectrum::gaussian(peak, between(10, 60), between(0.01, 1.0) / count),
                        Spectrum::gaussian(peak + between(-20, 120), between(8, 40), 1.0),
                        between(0.05, 1.0)});
    }
    return dyes;
}

/// The operator as the kernel applies it: in single precision, by a running sum.
Eigen::VectorXd applied_in_single(const LaneOperator& op, const Eigen::VectorXd& in) {
    const Eigen::MatrixXf emission = op.emission.cast<float>(),
                          excitation = op.excitation.cast<float>();
    const Eigen::VectorXf light = in.cast<float>();
    Eigen::VectorXf sum = Eigen::VectorXf::Zero(emission.cols()), out(in.size());
    for (Eigen::Index lane = 0; lane < in.size(); ++lane) {
        out(lane) =
            static_cast<float>(op.diagonal(lane)) * light(lane) + emission.row(lane).dot(sum);
        sum += excitation.row(lane).transpose() * light(lane);
    }
    return out.cast<double>();
}

Material dyed(std::vector<Fluorophore> dyes) {
    Material paint = material({}, 0.3);
    paint.substrate.fluorophores = std::move(dyes);
    return paint;
}

} // namespace

/// Factors of fluorophores span many orders of magnitude where a dye absorbs in the tail of its own
/// emission, and under a layer their products cancel: whatever is kept must be right in floats.
TEST(SubstrateOperator, FactorsOfDyesHoldInSinglePrecision) {
    std::mt19937 generator(5);
    double worst = 0.0;
    int factored = 0;
    for (int trial = 0; trial < 300; ++trial) {
        Scene scene = sphere_scene(dyed(random_dyes(generator, 1 + trial % 8)), 8, 8);
        const Substrate& substrate = scene.materials.front().substrate;
        const WavelengthPlan plan = plan_wavelengths(scene, {380, 6, 64}, {});
        const SubstrateOnCells on_cells = substrate_on_cells(substrate, plan.comb);
        if (!on_cells.is_factored())
            continue;
        ++factored;
        SubstrateOnCells dense = on_cells;
        dense.emission = dense.excitation = {};
        const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
        const Eigen::VectorXd r = Eigen::VectorXd::Constant(lanes, trial % 2 == 0 ? 0.6 : 0.95);
        const Eigen::VectorXd one = Eigen::VectorXd::Ones(lanes);
        const LaneOperator expected = lane_operator(substrate, dense, plan, 0, 1.0, r, one);
        const Eigen::VectorXd whole = expected.diagonal.cwiseProduct(one) + expected.dense * one;
        const Eigen::VectorXd got =
            applied_in_single(lane_operator(substrate, on_cells, plan, 0, 1.0, r, one), one);
        const double error = (got - whole).cwiseAbs().maxCoeff() / whole.maxCoeff();
        EXPECT_LT(error, 1e-5) << trial;
        worst = std::max(worst, error);
    }
    EXPECT_GT(factored, 250);
    RecordProperty("worst", std::to_string(worst));
}

} // namespace reradiant
