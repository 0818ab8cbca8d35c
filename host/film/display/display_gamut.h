#pragma once

#include "reradiant/colour.h"

#include <Eigen/Core>

namespace reradiant {

/// `DisplayGamut` takes colours into the gamut of a display, at constant hue of IPT (Ebner and
/// Fairchild, "Development and testing of a color space (IPT) with improved hue uniformity", CIC
/// 1998), whose cone responses are taken relative to the display's white, so that greys are exactly
/// neutral.
///
/// A colour moves on a straight line in the plane of its hue, towards the neutral that Ottosson
/// chooses ("sRGB gamut clipping", 2021, adaptive L0: nearly its own lightness for what is pale,
/// nearer to the middle for what is saturated, bright or dark). How far is said by the curve of the
/// ACES Reference Gamut Compression (Academy, 2020): what lies within 0.9 of the way from that
/// neutral to the gamut's surface stays, what lies beyond approaches the surface and never reaches
/// it. OpenColorIO's own transform of that name works by channels, towards the primaries of AP1
/// instead of the display's, and leaves most of what a display cannot show outside.
class DisplayGamut {
public:
    /// `xyz_of_primaries`: XYZ of the display's primaries, one a column; they add up to its white.
    explicit DisplayGamut(const Eigen::Matrix3d& xyz_of_primaries);

    /// Colours within nine tenths of the gamut, neutrals up to the white and not-finite colours are
    /// returned as they are; a neutral above the white becomes the white.
    Xyz compressed(const Xyz& xyz) const;

private:
    /// Lightness, and the chroma's two components.
    Eigen::Vector3d ipt_of(const Eigen::Vector3d& xyz) const;
    Eigen::Vector3d xyz_of(const Eigen::Vector3d& ipt) const;
    bool is_inside(const Eigen::Vector3d& ipt) const;

    double white_y_;
    Eigen::Matrix3d cones_of_xyz_, xyz_of_cones_, primaries_of_xyz_;
};

} // namespace reradiant
