#pragma once

#include "reradiant/reradiation.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace reradiant {

/// Light at emission = ratio * excitation as a monochromator of triangular bandpass lets it
/// through: `height` is the sum over emission bands at every excitation.
inline void add_scatter(ReradiationMatrix& matrix, double ratio, double height, double fwhm_nm) {
    constexpr int samples = 40;
    const WavelengthGrid& emission = matrix.emission;
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            for (int k = 0; k < samples; ++k) {
                const double nm =
                    emission.lower_edge_nm(o) + emission.step_nm * (k + 0.5) / samples;
                const double away = std::abs(nm - ratio * matrix.excitation.centre_nm(i));
                matrix.values(o, i) += height * std::max(0.0, 1.0 - away / fwhm_nm) / fwhm_nm *
                                       emission.step_nm / samples;
            }
}

inline void add_noise(ReradiationMatrix& matrix, double noise, std::mt19937& random) {
    std::normal_distribution<double> normal;
    for (double& value : matrix.values.reshaped())
        value += noise * normal(random);
}

/// One to three dyes with Gaussian bands over a reflectance of zero, or, `narrow`, the first with
/// lines as lanthanides emit them.
inline ReradiationMatrix random_dyes(const WavelengthGrid& emission,
                                     const WavelengthGrid& excitation, bool narrow,
                                     std::mt19937& random) {
    const auto between = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    ReradiationMatrix matrix{emission, excitation,
                             Eigen::MatrixXd::Zero(emission.count, excitation.count),
                             MatrixKind::Measured};
    const int count = 1 + static_cast<int>(between(0.0, 3.0));
    for (int k = 0; k < count; ++k) {
        double absorbs = between(300.0, 550.0), width = between(15.0, 45.0);
        double emits = absorbs + between(10.0, 140.0), emission_width = between(12.0, 45.0);
        if (narrow && k == 0) {
            absorbs = between(250.0, 420.0);
            width = between(4.0, 40.0);
            emits = between(450.0, 750.0);
            emission_width = between(2.0, 6.0);
        }
        const double share = between(0.05, 0.8) * emission.step_nm / emission_width;
        for (int i = 0; i < excitation.count; ++i)
            for (int o = 0; o < emission.count; ++o)
                if (emission.centre_nm(o) > excitation.centre_nm(i)) {
                    const double e = (emission.centre_nm(o) - emits) / emission_width;
                    const double x = (excitation.centre_nm(i) - absorbs) / width;
                    matrix.values(o, i) += share * std::exp(-0.5 * (e * e + x * x));
                }
    }
    return matrix;
}

} // namespace reradiant
