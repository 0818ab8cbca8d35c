#include "host/measure/measure_substrate.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

using namespace reradiant;

namespace {

/// A stack of smooth slabs in a closed form of its own: Stokes' series of interreflections
/// summed term by term, integrals by Simpson's rule.
struct SmoothSlabs {
    std::vector<double> ior{1.0}, tau{0.0};

    double cosine(std::size_t medium, double q) const {
        return std::sqrt(std::max(1.0 - q / (ior[medium] * ior[medium]), 0.0));
    }
    double fresnel(std::size_t above, double q) const {
        const double n1 = ior[above], n2 = ior[above + 1];
        const double c1 = cosine(above, q), c2 = cosine(above + 1, q);
        if (q >= n1 * n1 || q >= n2 * n2)
            return 1.0;
        const double s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        const double p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
        return 0.5 * (s * s + p * p);
    }
    struct Shares {
        double down, back, up_back;
    };
    /// Transmission to the substrate, reflection to the air, reflection from below.
    Shares shares(double q) const {
        Shares total{1.0, 0.0, 0.0};
        for (std::size_t k = 0; k + 1 < ior.size(); ++k) {
            const double f = fresnel(k, q), c = cosine(k + 1, q);
            // add interface k under what is there
            double through = 0.0, back = 0.0, up = f, flux = total.down, inner = (1 - f);
            for (int order = 0; order < 4000; ++order) {
                through += flux * (1 - f);
                back += flux * f * total.down;
                up += inner * total.up_back * (1 - f);
                flux *= f * total.up_back;
                inner *= total.up_back * f;
            }
            const double a = tau[k + 1] > 0 ? std::exp(-tau[k + 1] / c) : 1.0;
            total = {through * a, total.back + back, up * a * a};
        }
        return total;
    }
    double transmission(double theta) const {
        return shares(std::pow(std::sin(theta * M_PI / 180), 2)).down;
    }
    double specular(double theta) const {
        return shares(std::pow(std::sin(theta * M_PI / 180), 2)).back;
    }
    /// 2 integral R_up c dc in the lowest medium over pieces between critical angles.
    double internal() const {
        const double n = ior.back();
        std::vector<double> edges{0.0, n * n};
        for (const double other : ior)
            if (other < n)
                edges.push_back(other * other);
        std::sort(edges.begin(), edges.end());
        double sum = 0.0;
        for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
            const int steps = 400;
            for (int i = 0; i <= steps; ++i) {
                const double u = 0.5 * M_PI * i / steps, s = std::sin(u);
                const double w = i == 0 || i == steps ? 1 : (i % 2 == 1 ? 4 : 2);
                const double q = edges[k] + (edges[k + 1] - edges[k]) * s * s;
                sum += w * shares(q).up_back * std::sin(2 * u) * (edges[k + 1] - edges[k]) * 0.5 *
                       M_PI / steps / 3;
            }
        }
        return sum / (n * n);
    }
};

LayerStack stack_of(const SmoothSlabs& slabs) {
    LayerStack stack;
    for (std::size_t k = 1; k < slabs.ior.size(); ++k) {
        Layer layer;
        layer.ior = Spectrum::constant(slabs.ior[k]);
        layer.absorption = Spectrum::constant(slabs.tau[k]);
        stack.layers.push_back(layer);
    }
    return stack;
}

/// Reflectance plus a Stokes shift from 400 to 500 and 600 nm and from 500 to 600 nm.
Eigen::MatrixXd stokes_matrix() {
    Eigen::MatrixXd m(3, 3);
    m << 0.3, 0, 0, 0.2, 0.5, 0, 0.15, 0.1, 0.8;
    return m;
}
const WavelengthGrid grid{400, 100, 3};

/// M (1 - R M)^-1 by its series.
Eigen::MatrixXd interreflected(const Eigen::MatrixXd& m, double r) {
    Eigen::MatrixXd sum = m, term = m;
    for (int order = 0; order < 2000; ++order) {
        term = (r * m * term).eval();
        sum += term;
    }
    return sum;
}

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
