#include "tests/fit/dye_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

const DyeView usual_view{{std::numbers::sqrt2 / 2.0, Side::Above}, Side::Above, 1.0};

DyeSample sample_over(double reflectance, double alpha) {
    DyeSample sample;
    sample.stack.layers.resize(1);
    sample.stack.layers[0].alpha = alpha;
    sample.matrix = reflectance * Matrix::Identity(dye_bands.count, dye_bands.count);
    sample.views = {usual_view};
    return sample;
}

const BandRange all_bands{0, dye_bands.count};

/// What the model that renders says of the same sample, as a radiance factor.
Matrix by_emitting_stack(const DyeSample& sample, const std::vector<SlabDye>& dyes,
                         const std::vector<Matrix>& slabs) {
    LayerStack stack = sample.stack;
    stack.layers[sample.layer].dyes = dyes;
    DyedStack dyed;
    for (const double nm : dye_bands.centres_nm()) {
        dyed.by_band.push_back(stack_at(stack, nm));
        if (!stack.is_sheet())
            dyed.by_band.back() = stack_over(std::move(dyed.by_band.back()), DiffuseValues{});
    }
    dyed.slabs = slabs;
    dyed.substrate = sample.matrix;
    const EmittingStack emitting(std::move(dyed));
    const DyeView& view = sample.views.front();
    if (!view.cosine)
        return emitting.albedo(view.from, view.seen, EmittingStack::Part::All);
    return std::numbers::pi *
           emitting.value(view.from, {*view.cosine, view.seen}, EmittingStack::Part::All);
}

/// What the unknown dyes send out as the fit has it.
Matrix own_emission(const DyeValues& values) {
    Matrix sum = Matrix::Zero(dye_bands.count, dye_bands.count);
    for (std::size_t d = 0; d < values.shares.size(); ++d) {
        const auto dye = static_cast<Eigen::Index>(d);
        sum += values.quantum_yield(dye) * values.shares[d].matrix() *
               values.depth.col(dye).asDiagonal();
    }
    return sum;
}

double largest_difference(const Matrix& a, const Matrix& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

double fluorescent_peak(Matrix image) {
    image.diagonal().setZero();
    return image.maxCoeff();
}

} // namespace

TEST(DyeResponse, IsThatOfTheModelThatRenders) {
    // tables interpolate to some 1e-5 of the peak, and cells of depth are right to 1e-6
    for (const double reflectance : {0.0, 0.9})
        for (const double alpha : {0.0, 0.3})
            for (const double depth : {0.05, 0.5, 5.0}) {
                const DyeSample sample = sample_over(reflectance, alpha);
                const std::vector<SlabDye> dyes{green_dye(depth, 0.8)};
                const DyeValues values = values_of_dyes(dyes, dye_bands);
                const DyeStack stack(sample, dye_bands, 8.0);
                const Matrix image =
                    dye_images(stack, values, all_bands, all_bands, false).front().value;
                const Matrix truth = by_emitting_stack(sample, dyes, {own_emission(values)});
                EXPECT_LT(largest_difference(image, truth), 5e-5 * fluorescent_peak(truth))
                    << reflectance << " " << alpha << " " << depth;
            }
}

TEST(DyeResponse, EmissionOfOneNumberABandIsEnough) {
    // what a band of 10 nm hides of an emission's shape within it
    const DyeValues values = values_of_dyes({green_dye(1.0, 0.8)}, dye_bands);
    const Matrix true_shares = dye_shares(green_dye(1.0, 0.8), dye_bands);
    const Matrix own = 0.8 * values.shares[0].matrix();
    const Eigen::RowVectorXd weight = values.depth.col(0).transpose();
    EXPECT_LT(largest_difference(own * weight.asDiagonal(), true_shares * weight.asDiagonal()),
              5e-3 * true_shares.maxCoeff());
}

TEST(DyeResponse, DerivativesAreThoseOfDifferences) {
    DyeSample sample = sample_over(0.7, 0.0);
    sample.views.push_back({{0.3, Side::Above}, Side::Above, std::nullopt});
    const DyeStack stack(sample, dye_bands, 8.0);
    DyeValues values = values_of_dyes({green_dye(1.0, 0.8), orange_dye(0.7, 0.6)}, dye_bands);
    for (EmissionShares& shares : values.shares) // differences of tails would hold no digits
        shares = EmissionShares(shares.emission().array() + 1e-3, dye_bands);
    values.reflectance_added = Eigen::VectorXd::Constant(dye_bands.count, 0.05);
    const BandRange emission{8, 41};
    const auto images = [&](const DyeValues& at) {
        return dye_images(stack, at, emission, all_bands, false);
    };
    const auto exact = dye_images(stack, values, emission, all_bands, true);
    const auto check = [&](const Eigen::VectorXd& column, std::size_t view, double step,
                           const DyeValues& above, const DyeValues& below, const char* what) {
        const Matrix difference =
            (images(above)[view].value - images(below)[view].value) / (2.0 * step);
        EXPECT_LT((column - Eigen::VectorXd(difference.reshaped())).cwiseAbs().maxCoeff(),
                  1e-7 + 1e-6 * column.cwiseAbs().maxCoeff())
            << what;
    };
    for (const std::size_t view : {0u, 1u})
        for (const Eigen::Index band : {22, 24, 27, 31})
            for (const Eigen::Index dye : {0, 1}) {
                DyeValues above = values, below = values;
                double step = 1e-5 * std::max(values.depth(band, dye), 1e-3);
                above.depth(band, dye) += step;
                below.depth(band, dye) -= step;
                const Eigen::Index column = dye * dye_bands.count + band;
                check(exact[view].by_depth.col(column), view, step, above, below, "depth");
                above = below = values;
                const auto d = static_cast<std::size_t>(dye);
                Eigen::VectorXd e = values.shares[d].emission();
                step = 1e-6;
                e(band) += step;
                above.shares[d] = EmissionShares(e, dye_bands);
                e(band) -= 2.0 * step;
                below.shares[d] = EmissionShares(e, dye_bands);
                check(exact[view].by_emission.col(column), view, step, above, below, "emission");
                step = 1e-6;
                above = below = values;
                above.quantum_yield(dye) += step;
                below.quantum_yield(dye) -= step;
                check(exact[view].by_yield.col(dye), view, step, above, below, "yield");
                above = below = values;
                above.reflectance_added(band) += step;
                below.reflectance_added(band) -= step;
                check(exact[view].by_reflectance.col(band), view, step, above, below,
                      "reflectance");
            }
}

} // namespace reradiant
