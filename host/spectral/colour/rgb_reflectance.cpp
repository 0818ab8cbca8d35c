#include "reradiant/colour.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

// Reflectance from sRGB after Jakob and Hanika, "A Low-Dimensional Function Space for Efficient
// Spectral Upsampling", EG 2019: r(l) = 1/2 + p / (2 sqrt(1 + p^2)) with a quadratic p(l). Their
// coefficients come from a table made in single precision; here they are solved in double for the
// one colour that is asked for, on the very table that is returned.

namespace reradiant {

namespace {

constexpr double from_nm = 360.0, step_nm = 5.0;
constexpr int nodes = 95; // to 830 nm
constexpr double lowest_nm = 1.0, highest_nm = 1e5;

using Weights = Eigen::Matrix<double, 3, nodes>;
using Vector3 = Eigen::Vector3d;

/// rgb = weights * node values: what each node's hat function adds under D65. The white of the CIE
/// table is mapped to that of sRGB (they differ by 2e-4), so that grey is spectrally flat.
const Weights& rgb_weights() {
    static const Weights result = [] {
        const Spectrum d65 = illuminant_with_luminance("D65", 1.0);
        const Xyz white = linear_srgb_to_xyz({1.0, 1.0, 1.0});
        const ColourMatching& eye = cie_1931_2_degree();
        Eigen::Matrix<double, 3, nodes> xyz = Eigen::Matrix<double, 3, nodes>::Zero();
        Vector3 sum = Vector3::Zero();
        for (std::size_t k = 0; k < eye.wavelengths_nm.size(); ++k) {
            const double l = eye.wavelengths_nm[k], position = (l - from_nm) / step_nm;
            const int left = std::clamp(static_cast<int>(position), 0, nodes - 2);
            const double t = position - left;
            const Vector3 power = d65(l) * Vector3(eye.x[k], eye.y[k], eye.z[k]);
            xyz.col(left) += (1.0 - t) * power;
            xyz.col(left + 1) += t * power;
            sum += power;
        }
        for (Eigen::Index c = 0; c < 3; ++c)
            xyz.row(c) *= white[static_cast<std::size_t>(c)] / sum[c];
        Weights rgb;
        for (int node = 0; node < nodes; ++node) {
            const auto colour = xyz_to_linear_srgb({xyz(0, node), xyz(1, node), xyz(2, node)});
            rgb.col(node) = Vector3(colour[0], colour[1], colour[2]);
        }
        return rgb;
    }();
    return result;
}

/// Reflectance at the nodes and its derivative by p, from p(t) = c0 t^2 + c1 t + c2 on [-1, 1].
struct Sigmoid {
    Eigen::Matrix<double, nodes, 1> reflectance;
    Eigen::Matrix<double, nodes, 3> derivative;

    explicit Sigmoid(const Vector3& coefficients) {
        for (int node = 0; node < nodes; ++node) {
            const double t = 2.0 * node / (nodes - 1) - 1.0;
            const Eigen::RowVector3d powers(t * t, t, 1.0);
            const double p = powers.dot(coefficients), root = std::sqrt(1.0 + p * p);
            // The form that does not cancel for very negative p.
            reflectance[node] = p > 0.0 ? 0.5 + 0.5 * p / root : 0.5 / (root * (root - p));
            derivative.row(node) = powers * (0.5 / (root * root * root));
        }
    }
};

/// Levenberg-Marquardt from the grey of the same luminance.
Vector3 solve_coefficients(const Vector3& rgb) {
    constexpr int most_steps = 400;
    constexpr double close_enough = 1e-10;
    const double grey =
        std::clamp(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], 1e-3, 0.999);
    Vector3 coefficients(0.0, 0.0, (grey - 0.5) / std::sqrt(grey * (1.0 - grey)));
    Vector3 residual = rgb_weights() * Sigmoid(coefficients).reflectance - rgb;
    double damping = 1e-3;
    for (int step = 0; step < most_steps && residual.norm() > close_enough; ++step) {
        const Eigen::Matrix3d jacobian = rgb_weights() * Sigmoid(coefficients).derivative;
        Eigen::Matrix3d normal = jacobian.transpose() * jacobian;
        // Relative damping: the coefficients of saturated colours differ by orders of magnitude.
        normal.diagonal() *= 1.0 + damping;
        normal.diagonal().array() += 1e-15;
        const Vector3 trial = coefficients - normal.ldlt().solve(jacobian.transpose() * residual);
        const Vector3 trial_residual = rgb_weights() * Sigmoid(trial).reflectance - rgb;
        const bool better = trial.allFinite() && trial_residual.norm() < residual.norm();
        damping = std::clamp(damping * (better ? 0.3 : 5.0), 1e-12, 1e12);
        if (better) {
            coefficients = trial;
            residual = trial_residual;
        }
    }
    return coefficients;
}

} // namespace

Spectrum reflectance_from_rgb(const std::array<double, 3>& rgb) {
    for (const double component : rgb)
        if (!(component >= 0.0 && component <= 1.0))
            throw std::invalid_argument(
                fmt::format("the rgb component {} is not between 0 and 1", component));
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
        return Spectrum::constant(rgb[0]);
    const Sigmoid curve(solve_coefficients(Vector3(rgb[0], rgb[1], rgb[2])));
    std::vector<double> wavelengths_nm, values;
    for (int node = 0; node < nodes; ++node) {
        wavelengths_nm.push_back(from_nm + node * step_nm);
        values.push_back(curve.reflectance[node]);
    }
    // A model, not data: its ends hold everywhere, and nobody is warned of using them.
    wavelengths_nm.insert(wavelengths_nm.begin(), lowest_nm);
    values.insert(values.begin(), values.front());
    wavelengths_nm.push_back(highest_nm);
    values.push_back(values.back());
    return Spectrum::table(std::move(wavelengths_nm), std::move(values));
}

} // namespace reradiant
