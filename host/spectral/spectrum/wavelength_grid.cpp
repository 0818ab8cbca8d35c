#include "reradiant/wavelength_grid.h"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr double tolerance_in_steps = 1e-6;
constexpr int most_bands = 100000;

void require(bool holds, const std::string& sentence) {
    if (!holds)
        throw std::invalid_argument(sentence);
}

} // namespace

int WavelengthGrid::band_of(double wavelength_nm) const {
    const double position = std::floor((wavelength_nm - from_nm) / step_nm + 0.5);
    // Written so that NaN and infinities fall outside.
    if (!(position >= 0.0 && position < count))
        return -1;
    return static_cast<int>(position);
}

std::vector<double> WavelengthGrid::centres_nm() const {
    std::vector<double> centres;
    centres.reserve(static_cast<std::size_t>(count));
    for (int band = 0; band < count; ++band)
        centres.push_back(centre_nm(band));
    return centres;
}

WavelengthGrid grid_from_centres(const std::vector<double>& centres_nm, double step_of_single_nm) {
    require(!centres_nm.empty(), "a grid needs at least one wavelength");
    require(centres_nm.size() <= most_bands,
            fmt::format("{} wavelengths are more than {}", centres_nm.size(), most_bands));
    for (std::size_t i = 0; i < centres_nm.size(); ++i) {
        require(
            std::isfinite(centres_nm[i]) && centres_nm[i] > 0.0,
            fmt::format("wavelength {} ({} nm) is not a positive number", i + 1, centres_nm[i]));
        require(i == 0 || centres_nm[i] > centres_nm[i - 1],
                fmt::format("wavelength {} ({} nm) does not ascend", i + 1, centres_nm[i]));
    }
    if (centres_nm.size() == 1) {
        require(std::isfinite(step_of_single_nm) && step_of_single_nm > 0.0,
                fmt::format("the step {} nm is not a positive number", step_of_single_nm));
        return {centres_nm.front(), step_of_single_nm, 1};
    }
    const int count = static_cast<int>(centres_nm.size());
    const WavelengthGrid grid{centres_nm.front(),
                              (centres_nm.back() - centres_nm.front()) / (count - 1), count};
    for (int band = 1; band < count; ++band) {
        const double centre = centres_nm[static_cast<std::size_t>(band)];
        require(std::abs(centre - grid.centre_nm(band)) <= tolerance_in_steps * grid.step_nm,
                fmt::format("wavelength {} ({} nm) is not in equal steps of {:.9g} nm from {} nm",
                            band + 1, centre, grid.step_nm, grid.from_nm));
    }
    return grid;
}

WavelengthGrid grid_from_range(double from_nm, double to_nm, double step_nm) {
    require(std::isfinite(from_nm) && from_nm > 0.0,
            fmt::format("the first wavelength {} nm is not a positive number", from_nm));
    require(std::isfinite(step_nm) && step_nm > 0.0,
            fmt::format("the step {} nm is not a positive number", step_nm));
    require(std::isfinite(to_nm) && to_nm >= from_nm,
            fmt::format("the last wavelength {} nm is below the first, {} nm", to_nm, from_nm));
    const double steps = (to_nm - from_nm) / step_nm;
    require(steps <= most_bands - 1, fmt::format("{} to {} nm by {} nm makes more than {} bands",
                                                 from_nm, to_nm, step_nm, most_bands));
    require(std::abs(steps - std::round(steps)) <= tolerance_in_steps,
            fmt::format("{} to {} nm is not a whole number of steps of {} nm", from_nm, to_nm,
                        step_nm));
    return {from_nm, step_nm, static_cast<int>(std::lround(steps)) + 1};
}

} // namespace reradiant
