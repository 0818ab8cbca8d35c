#include "host/spectral/covariance/colour_intervals.h"

#include "host/spectral/colour/colour_indices.h"
#include "host/spectral/colour/lamp.h"
#include "host/spectral/covariance/colour_gradient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using namespace reradiant;

namespace {

/// A bright yellowish sample that fluoresces, with some noise; emission and excitation differ.
ReradiationMatrix sample(double emission_step_nm) {
    ReradiationMatrix matrix;
    matrix.emission = {380.0, emission_step_nm, static_cast<int>(400.0 / emission_step_nm) + 1};
    matrix.excitation = {300.0, 10.0, 49};
    matrix.values.setZero(matrix.emission.count, matrix.excitation.count);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> ripple(0.9, 1.1);
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o) {
            const double from = matrix.excitation.centre_nm(i), to = matrix.emission.centre_nm(o);
            if (from == to)
                matrix.values(o, i) = 0.2 + 0.001 * (to - 380.0);
            else if (to > from)
                matrix.values(o, i) = 0.02 * ripple(random) *
                                      std::exp(-std::pow((to - 520.0) / 60.0, 2) -
                                               std::pow((from - 400.0) / 60.0, 2));
        }
    return matrix;
}

/// Two shared causes and an error of its own for every entry that is not dark.
MatrixCovariance covariance_of(const ReradiationMatrix& matrix, double size) {
    MatrixCovariance covariance{matrix.emission, matrix.excitation,
                                Eigen::MatrixXd(matrix.values.size(), 2),
                                (matrix.values.array() > 0.0).cast<double>() * size * 2e-3};
    covariance.directions.col(0) = size * 0.01 * matrix.fluorescent_part().reshaped();
    covariance.directions.col(1) =
        size * 0.005 * (matrix.values - matrix.fluorescent_part()).reshaped();
    return covariance;
}

ReradiationMatrix drawn_matrix(const ReradiationMatrix& matrix, const MatrixCovariance& covariance,
                               std::mt19937& random) {
    std::normal_distribution<double> normal;
    ReradiationMatrix drawn = matrix;
    for (Eigen::Index k = 0; k < covariance.directions.cols(); ++k)
        drawn.values.reshaped() += normal(random) * covariance.directions.col(k);
    for (Eigen::Index k = 0; k < drawn.values.size(); ++k)
        drawn.values(k) += normal(random) * covariance.independent(k);
    return drawn;
}

const QuantityInterval& named(const std::vector<QuantityInterval>& list, const std::string& name) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const QuantityInterval& one) { return one.name == name; });
    if (found == list.end())
        throw std::out_of_range(name);
    return *found;
}

ColourReport report_with(const ReradiationMatrix& matrix, const MatrixCovariance& covariance,
                         const Lamp& lamp, Observer observer = Observer::Cie1931Deg2) {
    ColourReport report = colour_report(matrix, lamp, ColourSum::Automatic, observer);
    set_intervals(report, matrix, covariance, lamp, ColourSum::Automatic, 3);
    return report;
}

} // namespace

// Both are sums of the same products in another order.
TEST(ColourIntervals, WeightsOfEntriesGiveTheColour) {
    for (const double step : {10.0, 5.0}) {
        const ReradiationMatrix matrix = sample(step);
        for (const char* name : {"D65", "C", "FL11", "D65+20*L:365", "M0"})
            for (const ColourSum sum : {ColourSum::Automatic, ColourSum::E308}) {
                const Lamp lamp = lamp_from_text(name);
                const ColourConditions conditions{.observer = Observer::Cie1964Deg10,
                                                  .weighted_by = lamp.weighted_by,
                                                  .excites_from_nm = 350.0};
                const MatrixColour colour = colour_of_matrix(matrix, lamp.light, sum, conditions);
                const bool has_r457 = lamp.name == "D65" || lamp.name == "C";
                const Eigen::VectorXd sums =
                    colour_gradient(matrix, lamp.light, sum, colour.at_nanometres, conditions,
                                    has_r457)
                        .transpose() *
                    matrix.values.reshaped();
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(sums[static_cast<Eigen::Index>(c)], colour.xyz[c], 1e-9) << name;
                if (has_r457) {
                    EXPECT_NEAR(sums[3], *r457(colour), 1e-9) << name;
                }
            }
    }
}

// Standard errors of 600 draws are known to 2.9 %, those of 1,000 to 2.2 %: five of both are 18 %.
TEST(ColourIntervals, AreThoseOfMatricesThatAreDrawnOneByOne) {
    const ReradiationMatrix matrix = sample(10.0);
    const MatrixCovariance covariance = covariance_of(matrix, 1.0);
    for (const char* name : {"D65", "FL11"}) {
        const Lamp lamp = lamp_from_text(name);
        const ColourReport report = report_with(matrix, covariance, lamp);
        std::mt19937 random(11);
        constexpr int draws = 600;
        Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = sum;
        ColourReporter reporter(lamp, ColourSum::Automatic, Observer::Cie1931Deg2);
        for (int k = 0; k < draws; ++k) {
            const auto lab =
                reporter.report_of(drawn_matrix(matrix, covariance, random), {}).colour.lab;
            const Eigen::Array3d at(lab[0], lab[1], lab[2]);
            sum += at;
            squares += at * at;
        }
        const Eigen::Array3d error = ((squares - sum * sum / draws) / (draws - 1)).sqrt();
        for (const auto& list : {report.intervals->linearised, report.intervals->drawn})
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(named(list, "Lab").standard_error[c] /
                                error[static_cast<Eigen::Index>(c)],
                            1.0, 0.18)
                    << name << c;
    }
}

// An end of 1,000 draws has a standard error of 0.085 standard errors of the quantity; the largest
// of some 60 ends stays under four of these unless the two ways disagree.
TEST(ColourIntervals, LinearisationAndDrawsAgreeInEveryQuantity) {
    const ReradiationMatrix matrix = sample(10.0);
    const ColourReport report =
        report_with(matrix, covariance_of(matrix, 0.5), lamp_from_text("D65"));
    const ColourIntervals& both = *report.intervals;
    ASSERT_EQ(both.linearised.size(), 9u);
    for (const auto& [slopes, draws] :
         {std::pair(both.linearised, both.drawn),
          std::pair(both.uv_excluded_linearised, both.uv_excluded_drawn)})
        for (std::size_t k = 0; k < slopes.size(); ++k)
            for (std::size_t c = 0; c < slopes[k].low.size(); ++c) {
                const double error = slopes[k].standard_error[c];
                EXPECT_GT(error, 0.0) << slopes[k].name;
                EXPECT_NEAR(draws[k].low[c], slopes[k].low[c], 0.34 * error) << slopes[k].name;
                EXPECT_NEAR(draws[k].high[c], slopes[k].high[c], 0.34 * error) << slopes[k].name;
            }
}

// The hue of nearly grey samples passes 0: both ends stay beside the colour's own hue.
TEST(ColourIntervals, HuesGoOnBeyondZero) {
    ReradiationMatrix red;
    red.emission = red.excitation = {380.0, 10.0, 41};
    red.values.setZero(41, 41);
    for (int band = 0; band < 41; ++band)
        red.values(band, band) = band >= 22 ? 0.6 : band <= 5 ? 0.45 : 0.3;
    const MatrixCovariance errors{red.emission, red.excitation, Eigen::MatrixXd(41 * 41, 0),
                                  0.02 * Eigen::MatrixXd::Identity(41, 41)};
    const ColourReport report = report_with(red, errors, lamp_from_text("D65"));
    const double hue = report.lch[2];
    ASSERT_TRUE(hue < 20.0 || hue > 340.0) << hue;
    for (const auto& list : {report.intervals->linearised, report.intervals->drawn}) {
        const QuantityInterval& lch = named(list, "LCh");
        EXPECT_LT(lch.low[2], hue);
        EXPECT_GT(lch.high[2], hue);
        EXPECT_LT(lch.high[2] - lch.low[2], 40.0);
    }
}

TEST(ColourIntervals, ReflectanceWithIndependentErrorsHasAClosedForm) {
    ReradiationMatrix grey;
    grey.emission = grey.excitation = {380.0, 10.0, 41};
    grey.values = 0.2 * Eigen::MatrixXd::Identity(41, 41);
    MatrixCovariance errors = independent_errors(grey);
    errors.independent *= 0.01; // 0.002 on the diagonal
    const Spectrum lamp = illuminant("D65");
    const ColourMatching& eye = colour_matching(Observer::Cie1931Deg2);
    const Spectrum y = Spectrum::table(eye.wavelengths_nm, eye.y);
    double squares = 0.0, whole = 0.0;
    for (const double nm : grey.emission.centres_nm()) {
        const double weight = lamp(nm) * y(nm);
        squares += weight * weight;
        whole += weight;
    }
    const ColourReport report = report_with(grey, errors, lamp_from_text("D65"));
    EXPECT_NEAR(named(report.intervals->linearised, "XYZ").standard_error[1],
                100.0 * 0.002 * std::sqrt(squares) / whole, 1e-9);
}

TEST(ColourIntervals, WithoutUncertaintyBothEndsAreTheColour) {
    const ReradiationMatrix matrix = sample(10.0);
    const MatrixCovariance none = covariance_of(matrix, 0.0);
    const ColourReport report = report_with(matrix, none, lamp_from_text("D65"));
    for (const auto& list : {report.intervals->linearised, report.intervals->drawn})
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_LT(named(list, "Lab").standard_error[c], 1e-11); // rounding of sums
            EXPECT_NEAR(named(list, "Lab").low[c], report.colour.lab[c], 1e-12);
            EXPECT_NEAR(named(list, "Lab").high[c], report.colour.lab[c], 1e-12);
        }
}

TEST(ColourIntervals, UnknownErrorsAreWarnedOfWhereTheyCount) {
    const ReradiationMatrix matrix = sample(10.0);
    MatrixCovariance covariance = covariance_of(matrix, 1.0);
    covariance.independent.col(1).setConstant(std::numeric_limits<double>::quiet_NaN()); // 310 nm
    const auto warned = [&](const char* lamp) {
        const ColourReport report = report_with(matrix, covariance, lamp_from_text(lamp));
        return std::any_of(
            report.warnings.begin(), report.warnings.end(),
            [](const std::string& text) { return text.find("too narrow") != std::string::npos; });
    };
    EXPECT_TRUE(warned("D65"));
    EXPECT_FALSE(warned("LED-B3")); // its table begins at 380 nm, below it is dark
}

TEST(ColourIntervals, BelongToOneMatrix) {
    const ReradiationMatrix matrix = sample(10.0);
    MatrixCovariance covariance = covariance_of(matrix, 1.0);
    EXPECT_NO_THROW(require_covariance_of(matrix, covariance));
    EXPECT_THROW(require_covariance_of(sample(5.0), covariance), std::invalid_argument);
    covariance.matrix = matrix.values;
    EXPECT_NO_THROW(require_covariance_of(matrix, covariance));
    ReradiationMatrix other = matrix;
    other.values(20, 10) += 1e-4;
    EXPECT_THROW(require_covariance_of(other, covariance), std::invalid_argument);
}
