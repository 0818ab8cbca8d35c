#pragma once

#include "host/layers/models/adding.h"
#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/slab_emission.h"
#include "tests/layers/slab_cases.h"
#include "tests/support/directions.h"

#include <Eigen/Core>

#include <cmath>

/// Dyed stacks under adding at the three bands of the slab cases, and where their light goes.
namespace reradiant::test {

inline LayeredBsdf adding_of(const LayerStack& stack,
                             const Eigen::MatrixXd& substrate = Eigen::MatrixXd::Zero(3, 3)) {
    return {stack, {.matrix = substrate}, three_bands, adding_bsdf};
}

/// A direction of air by its angle from the upper normal.
inline AirDirection air_deg(double theta_deg) {
    return {std::fabs(std::cos(radians(theta_deg))), theta_deg < 90.0 ? Side::Above : Side::Below};
}

inline Side other_side(Side side) {
    return side == Side::Above ? Side::Below : Side::Above;
}

inline Eigen::MatrixXd all_light(const LayeredBsdf::Parts& parts) {
    return parts.diffuse + parts.slab + Eigen::MatrixXd(parts.specular.asDiagonal());
}

/// Shares of what comes in each band that leave or are guided in each, rows = emission.
inline Eigen::MatrixXd not_absorbed(const LayeredBsdf& bsdf, const AirDirection& from) {
    Eigen::MatrixXd sum = all_light(bsdf.albedo(from, from.side)) + bsdf.guided(from);
    if (bsdf.is_sheet())
        sum += all_light(bsdf.albedo(from, other_side(from.side)));
    return sum;
}

/// Power shares, rows = emission, as numbers of photons.
inline Eigen::MatrixXd in_photons(const Eigen::MatrixXd& shares) {
    const std::vector<double> nm = three_bands.centres_nm();
    const Eigen::Map<const Eigen::Vector3d> wavelength(nm.data());
    return wavelength.asDiagonal() * shares * wavelength.cwiseInverse().asDiagonal();
}

/// Shares that dyes send out without a loss of photons.
inline Eigen::MatrixXd keeping_photons(Eigen::MatrixXd shares) {
    const Eigen::RowVectorXd sums = in_photons(shares).colwise().sum();
    for (Eigen::Index i = 0; i < 3; ++i)
        if (sums(i) > 0.0)
            shares.col(i) /= sums(i);
    return shares;
}

} // namespace reradiant::test
