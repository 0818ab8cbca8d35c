#include "host/measure/measure_substrate.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "tests/measure/smooth_slabs.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

using namespace reradiant;
using test::grid;
using test::interreflected;
using test::SmoothSlabs;
using test::stack_of;
using test::stokes_matrix;

namespace {

const std::vector<SmoothSlabs> cases{
    {{1.0}, {0.0}},           {{1.0, 1.5}, {0.0, 0.0}}, {{1.0, 1.3, 1.6}, {0.0, 0.0, 0.0}},
    {{1.0, 1.5}, {0.0, 0.1}}, {{1.0, 1.5}, {0.0, 3.0}}, {{1.0, 1.6, 1.3}, {0.0, 0.1, 0.2}},
};

} // namespace

TEST(Measure, SmoothStacksOverAStokesShiftAgreeWithTheClosedForm) {
    const std::vector<double> thetas{0, 45, 80, 89};
    for (std::size_t k = 0; k < cases.size(); ++k) {
        MeasureRequest request;
        request.theta_i_deg = thetas;
        request.theta_o_deg = thetas;
        request.phi_deg = {90};
        const Measurement result =
            measure_stack(stack_of(cases[k]), stokes_matrix(), grid, request);
        const Eigen::MatrixXd centre = interreflected(stokes_matrix(), cases[k].internal());
        const double n = cases[k].ior.back();
        int diffuse = 0;
        for (const MeasureRow& row : result.rows) {
            if (row.part == MeasuredPart::Specular) {
                EXPECT_EQ(row.value, 0.0); // deltas are left out
                continue;
            }
            ++diffuse;
            const auto o = static_cast<Eigen::Index>((row.lambda_o_nm - 400) / 100);
            const auto i = static_cast<Eigen::Index>((row.lambda_i_nm - 400) / 100);
            const double expected = cases[k].transmission(row.theta_i_deg) * centre(o, i) *
                                    cases[k].transmission(row.theta_o_deg) / (M_PI * n * n);
            EXPECT_NEAR(row.value / expected, 1.0, 1e-8) << k; // Simpson's error; 1e-5 is asked for
        }
        EXPECT_EQ(diffuse, 4 * 4 * 6);
    }
}

TEST(Measure, WalkCountsWhatSeveralAntiStokesStepsReach) {
    // 600 to 500 and 500 to 400 nm, and nothing from 600 to 400 nm at once: only light that a layer
    // sends back goes all the way.
    Eigen::MatrixXd matrix(3, 3);
    matrix << 0.3, 0.25, 0, 0.1, 0.4, 0.25, 0.05, 0.1, 0.5;
    MeasureRequest request;
    request.theta_i_deg = {0, 60};
    request.theta_o_deg = {5, 45};
    request.samples = 1 << 15;
    for (const bool hemispherical : {false, true})
        for (const double alpha : {0.0, 0.3}) {
            request.hemispherical = hemispherical;
            LayerStack stack = stack_of({{1.0, 1.5}, {0.0, 0.1}});
            stack.layers[0].alpha = alpha;
            request.model = Model::Adding;
            const Measurement adding = measure_stack(stack, matrix, grid, request);
            request.model = Model::Walk;
            const Measurement walk = measure_stack(stack, matrix, grid, request);
            ASSERT_EQ(walk.rows.size(), adding.rows.size());
            int two_steps = 0;
            for (std::size_t k = 0; k < walk.rows.size(); ++k) {
                const MeasureRow &seen = walk.rows[k], &expected = adding.rows[k];
                ASSERT_EQ(seen.lambda_i_nm, expected.lambda_i_nm);
                ASSERT_EQ(seen.lambda_o_nm, expected.lambda_o_nm);
                ASSERT_EQ(seen.part, expected.part);
                if (seen.part != MeasuredPart::Diffuse)
                    continue;
                // Sidak over some 200 rows at 1e-6: 5.6; rough tables of adding are within 0.2 %.
                EXPECT_NEAR(seen.value, expected.value,
                            5.6 * seen.standard_error + 0.004 * expected.value)
                    << seen.lambda_i_nm << " to " << seen.lambda_o_nm << " nm, alpha " << alpha;
                if (seen.lambda_i_nm == 600.0 && seen.lambda_o_nm == 400.0) {
                    ++two_steps;
                    EXPECT_GT(seen.value, 0.0);
                }
            }
            EXPECT_EQ(two_steps, hemispherical ? 2 : 4);
        }
    // Bare, nothing sends light back: what the matrix does not do at once does not happen.
    request.hemispherical = true;
    request.model = Model::Walk;
    for (const MeasureRow& row : measure_stack({}, matrix, grid, request).rows)
        EXPECT_FALSE(row.lambda_i_nm == 600.0 && row.lambda_o_nm == 400.0);
}

TEST(Measure, HemisphericalRowsHoldTheMirrorAndConserveEnergy) {
    MeasureRequest request;
    request.theta_i_deg = {0, 45, 80, 89};
    request.hemispherical = true;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const bool lossless = *std::max_element(cases[k].tau.begin(), cases[k].tau.end()) == 0.0;
        const Measurement result =
            measure_stack(stack_of(cases[k]), Eigen::MatrixXd::Identity(3, 3), grid, request);
        ASSERT_EQ(result.rows.size(), 4U * 6U);
        for (std::size_t row = 0; row < result.rows.size(); row += 6) {
            const double diffuse = result.rows[row].value;
            const double specular = result.rows[row + 3].value;
            EXPECT_NEAR(specular, cases[k].specular(result.rows[row].theta_i_deg), 1e-9);
            if (lossless)
                EXPECT_NEAR(diffuse + specular, 1.0, 1e-12);
            else
                EXPECT_LT(diffuse + specular, 1.0);
        }
    }
}

TEST(Measure, WeidlichWilkieHemisphericalIsTheIntegralOfTheDirectional) {
    LayerStack stack = stack_of(cases[1]);
    stack.layers[0].distribution = Distribution::Blinn;
    stack.layers[0].alpha = 0.3;
    MeasureRequest request;
    request.model = Model::WeidlichWilkie;
    request.theta_i_deg = {40};
    request.theta_o_deg.clear();
    request.phi_deg.clear();
    const int steps = 60;
    for (int i = 0; i < steps; ++i) {
        request.theta_o_deg.push_back((i + 0.5) * 90.0 / steps);
        request.phi_deg.push_back((i + 0.5) * 180.0 / steps);
    }
    const Eigen::MatrixXd m = Eigen::MatrixXd::Constant(1, 1, 0.7);
    const WavelengthGrid one{550, 10, 1};
    double diffuse = 0.0, specular = 0.0;
    for (const MeasureRow& row : measure_stack(stack, m, one, request).rows) {
        const double t = row.theta_o_deg * M_PI / 180;
        const double weight = std::sin(t) * std::cos(t) * (0.5 * M_PI / steps) * (2 * M_PI / steps);
        (row.part == MeasuredPart::Diffuse ? diffuse : specular) += weight * row.value;
    }
    request.hemispherical = true;
    const Measurement whole = measure_stack(stack, m, one, request);
    ASSERT_EQ(whole.rows.size(), 2U);
    EXPECT_NEAR(whole.rows[0].value, diffuse, 1e-3 * diffuse); // midpoint rule of 60 x 60
    EXPECT_NEAR(whole.rows[1].value, specular, 3e-3 * specular);
}

TEST(Measure, WithoutFluorescenceEmissionIsExcitation) {
    const Measurement result =
        measure_stack({}, Eigen::MatrixXd(Eigen::Vector3d(0.1, 0.2, 0.3).asDiagonal()), grid, {});
    ASSERT_EQ(result.rows.size(), 6U);
    for (const MeasureRow& row : result.rows)
        EXPECT_EQ(row.lambda_i_nm, row.lambda_o_nm);
    EXPECT_NEAR(result.rows[1].value, 0.2 / M_PI, 1e-15);
}

TEST(Measure, WrongRequestsAreRefused) {
    const auto refused = [](auto change) {
        MeasureRequest request;
        change(request);
        EXPECT_THROW(measure_stack({}, Eigen::MatrixXd::Identity(3, 3), grid, request), Error);
    };
    refused([](MeasureRequest& r) { r.theta_i_deg = {90}; });
    refused([](MeasureRequest& r) { r.theta_i_deg = {-1}; });
    refused([](MeasureRequest& r) { r.theta_o_deg = {std::nan("")}; });
    refused([](MeasureRequest& r) { r.phi_deg = {400}; });
    refused([](MeasureRequest& r) { r.theta_i_deg.clear(); });
}

TEST(Measure, CsvHasTheDocumentedColumnsAndEmptyAnglesForHemispheres) {
    const auto file = std::filesystem::temp_directory_path() / "reradiant-test-measure.csv";
    MeasureRequest request;
    request.hemispherical = true;
    write_measurement(file, measure_stack(stack_of(cases[1]), stokes_matrix(), grid, request));
    std::ifstream in(file);
    std::string line;
    while (std::getline(in, line) && line[0] == '#') {
    }
    EXPECT_EQ(line, "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part");
    std::getline(in, line);
    EXPECT_EQ(line.substr(0, 11), "0,,,400,400");
    std::filesystem::remove(file);
}
