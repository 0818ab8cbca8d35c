#include "reradiant/colour.h"

#include "host/spectral/colour/bradford.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace reradiant {

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

/// CIE 15:2018, equation 8.4 to 8.6 with the exact fractions.
double lab_function(double t) {
    constexpr double threshold = 216.0 / 24389.0, slope = 841.0 / 108.0;
    return t > threshold ? std::cbrt(t) : slope * t + 4.0 / 29.0;
}

double hue_deg(double b, double a) {
    if (a == 0.0 && b == 0.0)
        return 0.0;
    const double hue = std::atan2(b, a) / degree;
    return hue < 0.0 ? hue + 360.0 : hue;
}

double pow7(double x) {
    return std::pow(x, 7.0);
}

/// sqrt(C^7 / (C^7 + 25^7)).
double chroma_ratio(double chroma) {
    return std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25.0)));
}

/// Mean hue and hue difference, in degrees, of two colours (Sharma et al. 2005, eqs. 10, 14).
struct Hues {
    double difference, mean;
};
Hues compare_hues(double h1, double h2, bool grey) {
    if (grey)
        return {0.0, h1 + h2};
    double difference = h2 - h1;
    if (difference > 180.0)
        difference -= 360.0;
    else if (difference < -180.0)
        difference += 360.0;
    double mean = 0.5 * (h1 + h2);
    if (std::abs(h1 - h2) > 180.0)
        mean += h1 + h2 < 360.0 ? 180.0 : -180.0;
    return {difference, mean};
}

/// Returns the matrix from linear sRGB to XYZ, from the chromaticities of IEC 61966-2-1: the
/// printed matrix is this, rounded.
Eigen::Matrix3d srgb_matrix() {
    Eigen::Matrix3d primaries;
    primaries << 0.64 / 0.33, 0.30 / 0.60, 0.15 / 0.06, 1.0, 1.0, 1.0, 0.03 / 0.33, 0.10 / 0.60,
        0.79 / 0.06;
    const Eigen::Vector3d white(0.3127 / 0.3290, 1.0, 0.3583 / 0.3290);
    const Eigen::Vector3d scale = primaries.inverse() * white;
    return primaries * scale.asDiagonal();
}

std::array<double, 3> product(const Eigen::Matrix3d& matrix, const std::array<double, 3>& v) {
    const Eigen::Vector3d result = matrix * Eigen::Vector3d(v[0], v[1], v[2]);
    return {result[0], result[1], result[2]};
}

const Eigen::Matrix3d& bradford_matrix() {
    static const Eigen::Matrix3d matrix{
        {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    return matrix;
}

} // namespace

std::array<double, 3> xyz_to_lab(const Xyz& xyz, const Xyz& white) {
    const double x = lab_function(xyz[0] / white[0]), y = lab_function(xyz[1] / white[1]),
                 z = lab_function(xyz[2] / white[2]);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double ciede2000(const std::array<double, 3>& lab1, const std::array<double, 3>& lab2) {
    const double mean_c = 0.5 * (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2]));
    const double stretch = 1.0 + 0.5 * (1.0 - chroma_ratio(mean_c));
    const double a1 = stretch * lab1[1], a2 = stretch * lab2[1];
    const double c1 = std::hypot(a1, lab1[2]), c2 = std::hypot(a2, lab2[2]);
    const Hues hues = compare_hues(hue_deg(lab1[2], a1), hue_deg(lab2[2], a2), c1 * c2 == 0.0);
    const double delta_l = lab2[0] - lab1[0], delta_c = c2 - c1;
    const double delta_h = 2.0 * std::sqrt(c1 * c2) * std::sin(0.5 * hues.difference * degree);
    const double mean_l = 0.5 * (lab1[0] + lab2[0]), mean_c_stretched = 0.5 * (c1 + c2);
    const double t = 1.0 - 0.17 * std::cos((hues.mean - 30.0) * degree) +
                     0.24 * std::cos(2.0 * hues.mean * degree) +
                     0.32 * std::cos((3.0 * hues.mean + 6.0) * degree) -
                     0.20 * std::cos((4.0 * hues.mean - 63.0) * degree);
    const double l50 = (mean_l - 50.0) * (mean_l - 50.0);
    const double s_l = 1.0 + 0.015 * l50 / std::sqrt(20.0 + l50);
    const double s_c = 1.0 + 0.045 * mean_c_stretched;
    const double s_h = 1.0 + 0.015 * mean_c_stretched * t;
    const double bend = (hues.mean - 275.0) / 25.0;
    const double rotation =
        -std::sin(60.0 * std::exp(-bend * bend) * degree) * 2.0 * chroma_ratio(mean_c_stretched);
    const double l = delta_l / s_l, c = delta_c / s_c, h = delta_h / s_h;
    return std::sqrt(std::max(0.0, l * l + c * c + h * h + rotation * c * h));
}

std::array<double, 3> xyz_to_linear_srgb(const Xyz& xyz) {
    static const Eigen::Matrix3d matrix = srgb_matrix().inverse();
    return product(matrix, xyz);
}

Xyz linear_srgb_to_xyz(const std::array<double, 3>& rgb) {
    static const Eigen::Matrix3d matrix = srgb_matrix();
    return product(matrix, rgb);
}

std::array<double, 3> bradford_cones(const Xyz& xyz) {
    return product(bradford_matrix(), xyz);
}

Xyz adapt_white(const Xyz& xyz, const Xyz& from_white, const Xyz& to_white) {
    static const Eigen::Matrix3d back = bradford_matrix().inverse();
    const auto from = bradford_cones(from_white), to = bradford_cones(to_white);
    auto cones = bradford_cones(xyz);
    for (std::size_t c = 0; c < 3; ++c)
        cones[c] *= to[c] / from[c];
    return product(back, cones);
}

} // namespace reradiant
