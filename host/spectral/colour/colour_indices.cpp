#include "host/spectral/colour/colour_indices.h"

#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Lab = std::array<double, 3>;

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Differences of lightness and chroma, and the square of that of hue.
struct Steps {
    double lightness, chroma, hue_squared;
};
Steps steps(const Lab& reference, const Lab& sample) {
    const double l = sample[0] - reference[0];
    const double c = std::hypot(sample[1], sample[2]) - std::hypot(reference[1], reference[2]);
    const double a = sample[1] - reference[1], b = sample[2] - reference[2];
    return {l, c, std::max(0.0, a * a + b * b - c * c)};
}

double weighted(const Steps& step, double s_l, double s_c, double s_h) {
    const double l = step.lightness / s_l, c = step.chroma / s_c;
    return std::sqrt(l * l + c * c + step.hue_squared / (s_h * s_h));
}

double cie1994(const Steps& step, double chroma) {
    return weighted(step, 1.0, 1.0 + 0.045 * chroma, 1.0 + 0.015 * chroma);
}

double cmc21(const Steps& step, const Lab& lch) {
    const double l = lch[0], c = lch[1], h = lch[2];
    const double s_l = l < 16.0 ? 0.511 : 0.040975 * l / (1.0 + 0.01765 * l);
    const double s_c = 0.0638 * c / (1.0 + 0.0131 * c) + 0.638;
    const double f = std::sqrt(std::pow(c, 4.0) / (std::pow(c, 4.0) + 1900.0));
    const double t = h >= 164.0 && h <= 345.0
                         ? 0.56 + std::abs(0.2 * std::cos((h + 168.0) * degree))
                         : 0.36 + std::abs(0.4 * std::cos((h + 35.0) * degree));
    return weighted(step, 2.0 * s_l, s_c, s_c * (f * t + 1.0 - f));
}

/// Value between the bands; NaN where a band is.
double at(const MatrixColour& colour, double nm) {
    const auto right = static_cast<std::size_t>(
        std::lower_bound(colour.nm.begin(), colour.nm.end(), nm) - colour.nm.begin());
    if (colour.nm[right] == nm)
        return colour.total[right];
    const double t = (nm - colour.nm[right - 1]) / (colour.nm[right] - colour.nm[right - 1]);
    return (1.0 - t) * colour.total[right - 1] + t * colour.total[right];
}

} // namespace

std::array<double, 3> lab_to_lch(const Lab& lab) {
    const double hue = std::atan2(lab[2], lab[1]) / degree;
    return {lab[0], std::hypot(lab[1], lab[2]), hue < 0.0 ? hue + 360.0 : hue};
}

ColourDifferences colour_differences(const Lab& reference, const Lab& sample) {
    const Steps step = steps(reference, sample);
    const Lab lch = lab_to_lch(reference);
    return {weighted(step, 1.0, 1.0, 1.0), cie1994(step, lch[1]), ciede2000(reference, sample),
            cmc21(step, lch)};
}

std::optional<E313> astm_e313(const Xyz& xyz, const std::string& illuminant, Observer observer) {
    const bool is_d65 = illuminant == "D65";
    if (!is_d65 && illuminant != "C")
        return std::nullopt;
    double cx = 0.0, cz = 0.0; // ASTM E313, table 1
    if (observer == Observer::Cie1931Deg2) {
        cx = is_d65 ? 1.2985 : 1.2769;
        cz = is_d65 ? 1.1335 : 1.0592;
    } else if (observer == Observer::Cie1964Deg10) {
        cx = is_d65 ? 1.3013 : 1.2871;
        cz = is_d65 ? 1.1498 : 1.0781;
    } else {
        return std::nullopt;
    }
    return E313{3.388 * xyz[2] - 3.0 * xyz[1], 100.0 * (cx * xyz[0] - cz * xyz[2]) / xyz[1]};
}

std::optional<double> r457(const MatrixColour& colour) {
    static const NumberTable weights =
        read_number_table(spectra_directory() / "brightness" / "r457.csv", 2);
    const std::vector<double>& nm = weights.columns[0];
    if (colour.nm.empty() || colour.nm.front() > nm.front() || colour.nm.back() < nm.back())
        return std::nullopt;
    double sum = 0.0, of_weights = 0.0;
    for (std::size_t k = 0; k < nm.size(); ++k) {
        sum += weights.columns[1][k] * at(colour, nm[k]);
        of_weights += weights.columns[1][k];
    }
    if (!std::isfinite(sum))
        return std::nullopt;
    return 100.0 * sum / of_weights;
}

double metamerism_index(const MatrixColour& reference_at_reference_lamp,
                        const MatrixColour& sample_at_reference_lamp,
                        const MatrixColour& reference_at_test_lamp,
                        const MatrixColour& sample_at_test_lamp) {
    Xyz corrected = sample_at_test_lamp.xyz;
    for (std::size_t c = 0; c < 3; ++c)
        corrected[c] *= reference_at_reference_lamp.xyz[c] / sample_at_reference_lamp.xyz[c];
    const Lab lab = xyz_to_lab(corrected, sample_at_test_lamp.white);
    return colour_differences(reference_at_test_lamp.lab, lab).cie1976;
}

} // namespace reradiant
