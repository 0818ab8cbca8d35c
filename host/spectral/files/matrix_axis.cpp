#include "host/spectral/files/matrix_formats.h"

#include "host/spectral/spectrum/rounded_grid.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace reradiant {

namespace {

/// The entry that breaks equal steps, seen from the first step.
std::size_t first_uneven(const std::vector<PlacedWavelength>& axis) {
    const double step_nm = axis[1].nm - axis[0].nm;
    for (std::size_t k = 2; k < axis.size(); ++k)
        if (std::abs(axis[k].nm - axis[0].nm - static_cast<double>(k) * step_nm) > 1e-6 * step_nm)
            return k;
    return axis.size() - 1;
}

} // namespace

double half_last_digit(std::string_view number) {
    const auto exponent_at = std::min(number.find_first_of("eE"), number.size());
    const auto point = number.substr(0, exponent_at).find('.');
    const double decimals =
        point == std::string_view::npos ? 0.0 : static_cast<double>(exponent_at - point - 1);
    int exponent = 0; // as it stays where there is none
    auto digits = number.substr(std::min(exponent_at + 1, number.size()));
    if (digits.starts_with('+')) // from_chars takes none
        digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    return 0.5 * std::pow(10.0, exponent - decimals);
}

std::vector<int> sort_axis(std::vector<PlacedWavelength>& axis, const char* axis_name) {
    std::vector<int> order(axis.size());
    std::iota(order.begin(), order.end(), 0);
    const auto nm = [&](int k) { return axis[static_cast<std::size_t>(k)].nm; };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return nm(a) < nm(b); });
    std::vector<PlacedWavelength> sorted;
    for (const int k : order) {
        const PlacedWavelength& next = axis[static_cast<std::size_t>(k)];
        if (!sorted.empty() && next.nm == sorted.back().nm)
            throw_input_error(next.position,
                              fmt::format("{} wavelength {} nm is given twice", axis_name, next.nm),
                              "give each once");
        sorted.push_back(next);
    }
    axis = std::move(sorted);
    return order;
}

WavelengthGrid axis_grid(const std::vector<PlacedWavelength>& axis, const char* axis_name,
                         double step_of_single_nm) {
    // A number that ends with zeros may have lost them: the longest says how all were rounded.
    double rounding_nm = std::numeric_limits<double>::infinity();
    for (const PlacedWavelength& wavelength : axis)
        rounding_nm = std::min(rounding_nm, wavelength.rounding_nm);
    std::vector<RoundedWavelength> centres;
    for (const PlacedWavelength& wavelength : axis)
        centres.push_back({wavelength.nm, rounding_nm});
    try {
        return grid_from_rounded_centres(centres, step_of_single_nm);
    } catch (const std::invalid_argument& error) {
        const std::size_t at = axis.size() > 2 ? first_uneven(axis) : 0;
        throw_input_error(axis.empty() ? SourcePosition{} : axis[at].position,
                          fmt::format("{} wavelengths: {}", axis_name, error.what()),
                          "bands must be equally spaced");
    }
}

} // namespace reradiant
