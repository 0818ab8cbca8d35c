#include "host/film/display/display_gamut.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

/// Share of the way to the surface that is left as it is, and the power of the curve beyond.
constexpr double kept_share = 0.9, curve_power = 1.2;
/// Ottosson's alpha, how strongly saturated colours go towards the middle instead of sidewards.
constexpr double towards_middle = 2.0;

/// Ebner and Fairchild 1998: Hunt, Pointer and Estevez's cones of XYZ with a white of D65, the
/// power that they are raised to, and lightness and both chroma components of that.
const Eigen::Matrix3d& published_cones() {
    static const Eigen::Matrix3d matrix{
        {0.4002, 0.7075, -0.0807}, {-0.2280, 1.1500, 0.0612}, {0.0, 0.0, 0.9184}};
    return matrix;
}
constexpr double cone_power = 0.43;
const Eigen::Matrix3d& ipt_of_cones() {
    static const Eigen::Matrix3d matrix{
        {0.4000, 0.4000, 0.2000}, {4.4550, -4.8510, 0.3960}, {0.8056, 0.3572, -1.1628}};
    return matrix;
}

double signed_power(double value, double power) {
    return std::copysign(std::pow(std::abs(value), power), value);
}

/// The ACES curve with its asymptote at 1; slope 1 where it begins.
double compressed_share(double share) {
    const double beyond = (share - kept_share) / (1.0 - kept_share);
    return kept_share + (1.0 - kept_share) * beyond /
                            std::pow(1.0 + std::pow(beyond, curve_power), 1.0 / curve_power);
}

/// Ottosson's adaptive L0 with the middle at 0.5: the neutral that a colour goes towards. For
/// chroma 0 it is the lightness itself, within 0 to 1.
double target_lightness(double lightness, double chroma) {
    const double from_middle = lightness - 0.5, distance = std::abs(from_middle);
    const double e = 0.5 + distance + towards_middle * chroma;
    const double root = std::sqrt(std::max(0.0, e * e - 2.0 * distance));
    return 0.5 * (1.0 + (from_middle < 0.0 ? -1.0 : 1.0) * (e - root));
}

} // namespace

DisplayGamut::DisplayGamut(const Eigen::Matrix3d& xyz_of_primaries) {
    const Eigen::Vector3d white = xyz_of_primaries.rowwise().sum();
    white_y_ = white[1];
    const Eigen::Vector3d white_cones = published_cones() * white / white_y_;
    cones_of_xyz_ = white_cones.cwiseInverse().asDiagonal() * published_cones();
    xyz_of_cones_ = cones_of_xyz_.inverse();
    primaries_of_xyz_ = (xyz_of_primaries / white_y_).inverse();
}

Eigen::Vector3d DisplayGamut::ipt_of(const Eigen::Vector3d& xyz) const {
    const Eigen::Vector3d cones = cones_of_xyz_ * xyz;
    return ipt_of_cones() *
           cones.unaryExpr([](double cone) { return signed_power(cone, cone_power); });
}

Eigen::Vector3d DisplayGamut::xyz_of(const Eigen::Vector3d& ipt) const {
    static const Eigen::Matrix3d cones_of_ipt = ipt_of_cones().inverse();
    const Eigen::Vector3d powers = cones_of_ipt * ipt;
    return xyz_of_cones_ *
           powers.unaryExpr([](double power) { return signed_power(power, 1.0 / cone_power); });
}

bool DisplayGamut::is_inside(const Eigen::Vector3d& ipt) const {
    constexpr double rounding = 1e-7;
    const Eigen::Vector3d rgb = primaries_of_xyz_ * xyz_of(ipt);
    return rgb.minCoeff() >= -rounding && rgb.maxCoeff() <= 1.0 + rounding;
}

Xyz DisplayGamut::compressed(const Xyz& xyz) const {
    const Eigen::Vector3d relative = Eigen::Vector3d(xyz[0], xyz[1], xyz[2]) / white_y_;
    if (!relative.allFinite())
        return xyz;
    const Eigen::Vector3d colour = ipt_of(relative);
    const double chroma = std::hypot(colour[1], colour[2]);
    const Eigen::Vector3d neutral(target_lightness(colour[0], chroma), 0.0, 0.0);
    const Eigen::Vector3d away = colour - neutral;
    if (is_inside(neutral + away / kept_share))
        return xyz;
    double inside = 0.0, outside = 1.0 / kept_share; // of the surface, in lengths of `away`
    constexpr int halvings = 30;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (inside + outside);
        (is_inside(neutral + middle * away) ? inside : outside) = middle;
    }
    constexpr double at_the_surface = 1e-9; // the neutral is on it: there is no way in
    const double shown = inside < at_the_surface ? 0.0 : inside * compressed_share(1.0 / inside);
    const Eigen::Vector3d result = white_y_ * xyz_of(neutral + shown * away);
    return {result[0], result[1], result[2]};
}

} // namespace reradiant
