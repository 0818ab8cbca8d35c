#include "host/fit/data/noise_estimate.h"

#include "host/fit/data/rounding_steps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Data without noise are weighed as if they had this share of their peak: single precision files
/// carry no more.
constexpr double smallest_noise = 1e-6;
/// 1.4826 times the median of |x| is the standard deviation of normal noise (Hampel 1974).
constexpr double normal_of_median = 1.4826;
constexpr std::size_t fewest_places = 16, fewest_of_a_column = 6;

double median(std::vector<double> values) {
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<double> entries_where(const Matrix& value, const Matrix& used) {
    std::vector<double> list;
    for (Eigen::Index k = 0; k < used.size(); ++k)
        if (used(k) > 0.0 && std::isfinite(value(k)))
            list.push_back(value(k));
    return list;
}

/// Binomial coefficients of changing sign: a difference of this order.
Vector difference(int order) {
    Vector weights = Vector::Ones(1);
    for (int k = 0; k < order; ++k) {
        Vector next = Vector::Zero(weights.size() + 1);
        next.head(weights.size()) += weights;
        next.tail(weights.size()) -= weights;
        weights = next;
    }
    return weights;
}

/// Estimate of the noise from fewer places than were asked for. It is infinite, so that any other
/// estimate is lower: that one is taken, since signal only adds to an estimate.
constexpr double nothing_seen = std::numeric_limits<double>::infinity();

/// Noise seen through differences with these weights along columns and rows.
double noise_of_differences(const Matrix& value, const Matrix& used, const Vector& down,
                            const Vector& right, std::size_t fewest) {
    std::vector<double> sizes;
    for (Eigen::Index i = 0; i + right.size() <= value.cols(); ++i)
        for (Eigen::Index o = 0; o + down.size() <= value.rows(); ++o)
            if (used.block(o, i, down.size(), right.size()).minCoeff() > 0.0)
                sizes.push_back(
                    std::abs(down.dot(value.block(o, i, down.size(), right.size()) * right)));
    if (sizes.size() < fewest)
        return nothing_seen;
    return normal_of_median * median(sizes) / (down.norm() * right.norm());
}

/// Returns the noise that is left of neighbouring columns when one is a multiple of the other.
double noise_of_proportion(const Matrix& value, const Matrix& used) {
    std::vector<double> sizes;
    for (Eigen::Index i = 0; i + 1 < value.cols(); ++i) {
        const Vector both = used.col(i).cwiseProduct(used.col(i + 1));
        const Vector a = value.col(i).cwiseProduct(both), b = value.col(i + 1).cwiseProduct(both);
        // Along the longer axis of the cloud of pairs, so that neither column is taken for exact.
        const double angle = 0.5 * std::atan2(2.0 * a.dot(b), a.squaredNorm() - b.squaredNorm());
        for (Eigen::Index o = 0; o < value.rows(); ++o)
            if (both(o) > 0.0)
                sizes.push_back(std::abs(std::cos(angle) * b(o) - std::sin(angle) * a(o)));
    }
    return sizes.size() < fewest_places ? nothing_seen : normal_of_median * median(sizes);
}

/// The least of several estimates of the same noise would be too low: another one must be so much
/// lower that the difference is signal.
double lower_estimate(double noise, double other) {
    constexpr double clearly = 0.75;
    return other < clearly * noise ? other : noise;
}

double noise_of_mixed_differences(const Matrix& value, const Matrix& used) {
    double noise = nothing_seen;
    for (const int order : {2, 4})
        noise = lower_estimate(noise, noise_of_differences(value, used, difference(order),
                                                           difference(order), fewest_places));
    return noise;
}

/// Noise of a single curve, as far as its differences tell.
double noise_along(const Matrix& value, const Matrix& used) {
    const Vector alone = Vector::Ones(1);
    double noise = nothing_seen;
    for (const int order : {2, 4, 6, 8})
        noise = lower_estimate(
            noise, noise_of_differences(value, used, difference(order), alone, fewest_of_a_column));
    return noise;
}

double noise_of_few_columns(const Matrix& value, const Matrix& used) {
    const Vector alone = Vector::Ones(1);
    double noise = noise_of_proportion(value, used);
    for (const int order : {2, 4, 6, 8}) {
        const Vector along = difference(order);
        for (const double other :
             {noise_of_differences(value, used, along, alone, fewest_of_a_column),
              noise_of_differences(value, used, alone, along, fewest_of_a_column)})
            noise = lower_estimate(noise, other);
    }
    return noise;
}

/// Zeros that stand for noise below zero.
struct CutOff {
    Matrix zeros; ///< 1 where one is
    double noise = 0.0;
};

/// Noise that lost its negative half: there is nothing below zero, and next to as many entries are
/// zero as are within two standard deviations above it (0.95 of a half). Rounding alone leaves
/// zeros, too; noise below half a step does not show.
CutOff cut_off_at_zero(const Matrix& value, const Matrix& used, const Matrix& steps) {
    constexpr double fewest = 8.0, share = 0.02, most_zeros = 3.0;
    CutOff cut{Matrix::Zero(value.rows(), value.cols())};
    const Matrix seen = (used.array() > 0.0).select(value, 0.0 * used);
    const Matrix zeros = (used.array() > 0.0 && value.array() == 0.0).cast<double>();
    if (seen.minCoeff() < 0.0 || zeros.sum() < std::max(fewest, share * used.sum()))
        return cut;
    // Differences of what was not cut off, and of all: a normal deviate without its negative half
    // has 0.58 of its standard deviation.
    constexpr double spread_of_half = 0.58;
    const Matrix whole = (seen.array() > 0.0).cast<double>();
    const double noise = std::min(noise_of_mixed_differences(value, whole),
                                  estimated_noise(value, used) / spread_of_half);
    const double step = steps.maxCoeff();
    const double small =
        (seen.array() > 0.0 && seen.array() < 2.0 * noise + 0.5 * step).cast<double>().sum();
    if (noise < 0.5 * step || zeros.sum() > most_zeros * small)
        return cut;
    cut.zeros = zeros;
    cut.noise = noise;
    return cut;
}

/// Steps of the diagonal have a row or a column of another unit where grids differ; those of
/// entries that are not used are none of theirs.
Matrix steps_of(const Matrix& value, const Matrix& used) {
    const Matrix gaps =
        Matrix::Constant(value.rows(), value.cols(), std::numeric_limits<double>::quiet_NaN());
    const Matrix of_used = rounding_steps((used.array() > 0.0).select(value, gaps));
    const Matrix of_others = rounding_steps((used.array() > 0.0).select(gaps, value));
    return (used.array() > 0.0).select(of_used, of_others);
}

void note_rounding(const Matrix& steps, const Matrix& used, double noise, EntryErrors& errors) {
    const double step = median(entries_where(steps, used));
    if (rounding_error(step) > noise)
        errors.notes.push_back(fmt::format("the data are in steps of {:.2g}: their rounding, "
                                           "{:.2g}, is weighed as noise",
                                           step, rounding_error(step)));
}

/// The mean error of rounding a value with noise is periodic in the value; its first harmonic
/// (Widrow and Kollar 2008, Quantization Noise, on dither) as a standard deviation.
Matrix shared_rounding(const Matrix& steps, double noise) {
    return steps.unaryExpr([noise](double step) {
        if (step <= 0.0)
            return 0.0;
        const double error = rounding_error(step); // the noise that was seen holds it, too
        const double other = std::max(0.0, noise * noise - error * error) / (step * step);
        return step / (std::numbers::pi * std::numbers::sqrt2) *
               std::exp(-2.0 * std::numbers::pi * std::numbers::pi * other);
    });
}

} // namespace

EntryErrors entry_errors(const Matrix& value, const Matrix& sigma, const Matrix& used) {
    constexpr double mean_of_half = -0.7978845608; // - sqrt(2 / pi)
    EntryErrors errors;
    errors.value = value;
    errors.sigma = sigma;
    const std::vector<double> given = entries_where(sigma, used);
    errors.is_estimated = given.empty();
    const Matrix steps = steps_of(value, used);
    const double peak = (used.array() > 0.0).select(value, 0.0 * used).cwiseAbs().maxCoeff();
    const double floor = smallest_noise * (peak > 0.0 ? peak : 1.0);
    const CutOff cut = cut_off_at_zero(value, used, steps);
    const double noise = !given.empty()    ? median(given)
                         : cut.noise > 0.0 ? cut.noise
                                           : estimated_noise(value, used);
    note_rounding(steps, used, noise, errors);
    errors.shared_rounding = shared_rounding(steps, noise);
    for (Eigen::Index k = 0; k < used.size(); ++k) {
        const double rounding = rounding_error(steps(k));
        errors.sigma(k) =
            std::isfinite(sigma(k)) ? std::hypot(sigma(k), rounding) : std::max(noise, rounding);
        errors.sigma(k) = std::max(errors.sigma(k), floor);
        if (cut.zeros(k) > 0.0)
            errors.value(k) = mean_of_half * errors.sigma(k);
    }
    errors.noise = std::max(floor, median(entries_where(errors.sigma, used)));
    if (!((used.array() > 0.0) && (errors.sigma.array() > floor)).any())
        errors.notes.push_back(
            fmt::format("no noise is seen in the data; weighed as if it were {:.1g}", floor));
    if (cut.zeros.sum() > 0.0)
        errors.notes.push_back(
            fmt::format("{} zeros stand where noise below zero was cut off; they are taken for its "
                        "mean, {:.2g} standard errors",
                        cut.zeros.sum(), mean_of_half));
    return errors;
}

double estimated_noise(const Matrix& value, const Matrix& used) {
    const Matrix seen = (used.array() > 0.0).select(value, 0.0 * used);
    double noise = noise_of_mixed_differences(seen, used);
    if (noise == nothing_seen)
        noise = noise_of_few_columns(seen, used);
    return noise == nothing_seen ? 0.0 : noise;
}

double estimated_curve_noise(const Vector& value) {
    const Matrix used = (value.array() == value.array()).cast<double>();
    const double noise = noise_along((used.array() > 0.0).select(value, 0.0 * used), used);
    return noise == nothing_seen ? 0.0 : noise;
}

} // namespace reradiant
