#include "host/fit/data/rounding_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

/// A step is only seen where several numbers are multiples of it.
constexpr std::size_t fewest_numbers = 4, fewest_levels = 3;
constexpr std::size_t fewest_of_digits = 16, fewest_levels_of_digits = 8;
/// Numbers with more digits than these are as good as not rounded.
constexpr int most_decimal_digits = 5, most_binary_digits = 12;
/// Steps below this share of the largest number do not matter.
constexpr double smallest_step = 1e-6;

struct Sizes {
    std::vector<double> all, levels; ///< sorted, without zeros; `levels` are distinct
    double error = 0.0;              ///< relative error of the numbers themselves

    explicit Sizes(const Matrix& value) {
        bool is_single = true;
        for (const double entry : value.reshaped()) {
            if (!std::isfinite(entry) || entry == 0.0)
                continue;
            all.push_back(std::abs(entry));
            is_single = is_single && entry == static_cast<double>(static_cast<float>(entry));
        }
        std::sort(all.begin(), all.end());
        // A unit or two are lost where a file's unit is converted.
        error = 2.0 * (is_single ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                 : std::numeric_limits<double>::epsilon());
        for (const double size : all)
            if (levels.empty() || size > levels.back() * (1.0 + error))
                levels.push_back(size);
    }
};

/// Euclid's algorithm on numbers that are only nearly multiples of one.
double common_step(const Sizes& sizes) {
    if (sizes.all.size() < fewest_numbers || sizes.levels.size() < fewest_levels)
        return 0.0;
    const double largest = sizes.levels.back();
    const double rounding = 4.0 * sizes.error * largest;
    const double least = std::max(smallest_step * largest, 20.0 * rounding);
    double step = sizes.levels.front();
    for (const double size : sizes.levels) {
        double rest = std::abs(size - step * std::round(size / step));
        while (rest > rounding) {
            const double next = std::abs(step - rest * std::round(step / rest));
            step = rest;
            rest = next;
        }
        if (step < least)
            return 0.0;
    }
    return step;
}

double unit_of_digits(double size, double base, int digits) {
    const double leading = std::floor(std::log(size) / std::log(base) + 1e-12);
    return std::pow(base, leading - digits + 1);
}

/// Digits that every number is written with; 0 where they are more than `most`.
int significant_digits(const Sizes& sizes, double base, int most) {
    if (sizes.all.size() < fewest_of_digits || sizes.levels.size() < fewest_levels_of_digits)
        return 0;
    int digits = 1;
    for (const double size : sizes.levels)
        for (;; ++digits) {
            const double units = size / unit_of_digits(size, base, digits);
            if (std::abs(units - std::round(units)) <= sizes.error * units)
                break;
            if (digits == most)
                return 0;
        }
    return digits;
}

} // namespace

Matrix rounding_steps(const Matrix& value) {
    const Sizes sizes(value);
    const double common = common_step(sizes);
    Matrix steps = Matrix::Constant(value.rows(), value.cols(), common);
    for (const auto& [base, most] :
         {std::pair{10.0, most_decimal_digits}, std::pair{2.0, most_binary_digits}}) {
        const int digits = significant_digits(sizes, base, most);
        // Multiples of one step have few digits, too; small numbers tell the two apart.
        if (digits == 0 || unit_of_digits(sizes.levels.back(), base, digits) < 100.0 * common)
            continue;
        for (Eigen::Index k = 0; k < value.size(); ++k)
            if (std::isfinite(value(k)) && value(k) != 0.0)
                steps(k) = std::max(steps(k), unit_of_digits(std::abs(value(k)), base, digits));
    }
    return steps;
}

double rounding_error(double step) {
    return step / std::sqrt(12.0);
}

} // namespace reradiant
