#include "host/fit/dye/result/dye_errors.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr double normal_95 = 1.959963984540054;
constexpr double chi_squared_95 = normal_95 * normal_95;
/// A relative standard error up to which a band is symmetric.
constexpr double small_error = 0.03;
/// So many data an estimate of the noise counts as beside the residuals (error_bands.cpp).
constexpr double data_of_estimate = 16.0;
constexpr int steps_of_a_profile = 6;

/// The chi squared profile of one parameter.
class Profile {
public:
    Profile(const DyeModel& model, const Vector& packed, Index parameter, double variance,
            const SolverSettings& settings)
        : model_(model), packed_(packed), parameter_(parameter), variance_(variance),
          settings_(settings), least_(model.chi_squared(packed)) {
        model_.hold(parameter);
        settings_.most_iterations = steps_of_a_profile;
    }

    /// Where chi squared has risen by 3.84 on the way to a limit, or the limit: as the rise is
    /// about a square, from one try to the next.
    double end(double towards, double limit) const {
        constexpr int most_tries = 5;
        constexpr double close_enough = 0.1;
        const double value = packed_(parameter_);
        Vector at = packed_;
        double tried = towards;
        for (int k = 0; k < most_tries; ++k) {
            const double rise = rise_at(tried, at) / chi_squared_95;
            if (std::fabs(rise - 1.0) < close_enough || (tried == limit && rise < 1.0))
                break;
            const double stretch = std::clamp(1.0 / std::sqrt(std::max(rise, 1e-6)), 0.3, 3.0);
            tried = std::clamp(value + stretch * (tried - value), std::min(limit, value),
                               std::max(limit, value));
        }
        return tried;
    }

private:
    double rise_at(double value, Vector& near) const {
        near(parameter_) = value;
        minimise_non_negative(model_, near, settings_, std::chrono::steady_clock::now());
        return (model_.chi_squared(near) - least_) / variance_;
    }

    DyeModel model_;
    const Vector& packed_;
    Index parameter_;
    double variance_;
    SolverSettings settings_;
    double least_;
};

/// A number and its band, by its profile where the standard error is not small.
BandedNumber banded(const DyeModel& model, const Vector& packed, Index parameter, double sigma,
                    double variance, double largest, const SolverSettings& settings) {
    const double value = packed(parameter);
    const auto within = [&](double end) { return std::clamp(end, 0.0, std::max(largest, value)); };
    BandedNumber number{value, within(value - normal_95 * sigma),
                        within(value + normal_95 * sigma)};
    if (!(sigma > small_error * value))
        return number;
    const Profile profile(model, packed, parameter, variance, settings);
    number.low = value > 0.0 ? profile.end(number.low, 0.0) : 0.0;
    number.high = value < largest ? profile.end(number.high, largest) : value;
    return number;
}

/// Largest of a dye's coefficients of absorption.
Index peak_parameter(const DyeModel& model, const Vector& packed, int dye) {
    const Index count = model.absorption_basis().size();
    Index peak = 0;
    packed.segment(dye * count, count).maxCoeff(&peak);
    return dye * count + peak;
}

/// Standard errors of a spectrum of a basis: those of what the curves' coefficients have in common,
/// and those of coefficients that were not seen, each by itself.
Vector curve_errors(const Matrix& curves, const Matrix& root, const Matrix& basis,
                    const Vector& unseen) {
    return ((curves * root).rowwise().squaredNorm() + basis.cwiseAbs2() * unseen.cwiseAbs2())
        .cwiseSqrt();
}

/// Derivative of an emission that adds up to 1 by its coefficients.
Matrix by_coefficients(const DyeModel& model, const Vector& coefficients) {
    const Matrix& basis = model.emission_basis().values;
    const Vector curve = basis * coefficients;
    const double sum = std::max(curve.sum(), 1e-300);
    return (basis - curve / sum * basis.colwise().sum()) / sum;
}

} // namespace

DyeCovariance dye_covariance(const DyeModel& model, const Vector& packed, bool noise_is_estimated) {
    Vector residual;
    Matrix jacobian;
    model.evaluate(packed, residual, &jacobian);
    const Index data = model.problem().used_count();
    const double chi_squared = residual.head(data).squaredNorm();
    const double freedom =
        std::max(1.0, static_cast<double>(data - (packed.array() > 0.0).count() + model.dyes()));
    DyeCovariance result;
    result.variance = noise_is_estimated
                          ? (data_of_estimate + chi_squared) / (data_of_estimate + freedom)
                          : std::max(1.0, chi_squared / freedom);
    result.covariance = covariance_of(
        jacobian, firmly_at_zero(model, packed, jacobian.transpose() * residual, jacobian),
        result.variance);
    result.sigma = result.covariance.root.rowwise().norm();
    return result;
}

std::vector<Index> unseen_coefficients(const DyeModel& model, DyeSpectrum which,
                                       const Vector& packed, const Vector& sigma) {
    constexpr double small_beside_best = 0.02, clearly = 2.0;
    const bool is_emission = which == DyeSpectrum::Emission;
    const Index count =
        is_emission ? model.emission_basis().size() : model.absorption_basis().size();
    std::vector<Index> unseen;
    for (int dye = 0; dye < model.dyes(); ++dye) {
        const Index first = (is_emission ? model.places().emission : 0) + dye * count;
        Index best = 0;
        packed.segment(first, count)
            .cwiseQuotient(sigma.segment(first, count).cwiseMax(1e-12))
            .maxCoeff(&best);
        for (const Index step : {-1, 1}) {
            bool is_beyond = false;
            for (Index k = best; k >= 0 && k < count && (is_emission || step > 0); k += step) {
                const double error = sigma(first + k);
                const bool is_uncertain = error > small_beside_best * packed(first + best);
                is_beyond = is_beyond || (is_uncertain && packed(first + k) <= clearly * error);
                if (is_beyond && is_uncertain)
                    unseen.push_back(first + k);
            }
        }
    }
    return unseen;
}

DyeErrors dye_errors(const DyeModel& model, const Vector& packed, const DyeCovariance& covariance,
                     const Vector& unseen, const SolverSettings& settings) {
    const Matrix& root = covariance.covariance.root;
    const DyeModel::Places at = model.places();
    const Index a = model.absorption_basis().size(), e = model.emission_basis().size();
    const BandRange& emission = model.problem().emission;
    DyeErrors errors;
    errors.absorption.resize(model.problem().bands.count, model.dyes());
    errors.emission = Matrix::Zero(model.problem().bands.count, model.dyes());
    for (int dye = 0; dye < model.dyes(); ++dye) {
        const Index own_a = dye * a, own_e = at.emission + dye * e;
        errors.absorption.col(dye) =
            curve_errors(model.absorption_basis().values, root.middleRows(own_a, a),
                         model.absorption_basis().values, unseen.segment(own_a, a));
        errors.emission.col(dye).segment(emission.first, emission.count) = curve_errors(
            by_coefficients(model, packed.segment(own_e, e)), root.middleRows(own_e, e),
            model.emission_basis().values, unseen.segment(own_e, e));
        const auto band_of = [&](Index parameter, double largest) {
            return banded(model, packed, parameter, covariance.sigma(parameter),
                          covariance.variance, largest, settings);
        };
        errors.quantum_yield.push_back(band_of(at.quantum_yield + dye, 1.0));
        errors.absorption_at_peak.push_back(
            band_of(peak_parameter(model, packed, dye), model.problem().largest_absorption()));
    }
    if (model.problem().fits_scale) {
        const double sigma = normal_95 * covariance.sigma(at.scale);
        errors.scale = {packed(at.scale), std::max(0.0, packed(at.scale) - sigma),
                        packed(at.scale) + sigma};
    }
    if (model.problem().fits_substrate)
        errors.reflectance = covariance.sigma.tail(model.problem().bands.count);
    return errors;
}

} // namespace reradiant
