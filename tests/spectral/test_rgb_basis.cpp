#include "host/spectral/colour/rgb_basis.h"

#include "reradiant/colour.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

TEST(RgbBasis, PartitionsUnityWithoutNegativeValues) {
    const auto& basis = rgb_basis();
    for (double nm = 300.0; nm <= 830.0; nm += 1.0) {
        double sum = 0.0;
        for (const Spectrum& primary : basis) {
            EXPECT_GE(primary(nm), 0.0) << nm;
            sum += primary(nm);
        }
        EXPECT_NEAR(sum, 1.0, 1e-9) << nm;
    }
}

TEST(RgbBasis, HasTheColoursOfItsPrimariesUnderD65) {
    const ColourMatching& eye = cie_1931_2_degree();
    const Spectrum light = illuminant("D65");
    double white_y = 0.0;
    std::array<std::array<double, 3>, 3> rgb{};
    for (std::size_t k = 0; k < eye.wavelengths_nm.size(); ++k)
        white_y += light(eye.wavelengths_nm[k]) * eye.y[k];
    for (std::size_t p = 0; p < 3; ++p) {
        Xyz xyz{};
        for (std::size_t k = 0; k < eye.wavelengths_nm.size(); ++k) {
            const double nm = eye.wavelengths_nm[k];
            const double power = light(nm) * rgb_basis()[p](nm) / white_y;
            xyz[0] += power * eye.x[k];
            xyz[1] += power * eye.y[k];
            xyz[2] += power * eye.z[k];
        }
        rgb[p] = xyz_to_linear_srgb(xyz);
    }
    // red and green are solved for; blue is what they leave of white, and sRGB's white differs
    // from the D65 table's by a few 1e-4
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(rgb[p][c], p == c ? 1.0 : 0.0, p == 2 ? 2e-3 : 1e-6) << p << c;
}

} // namespace
} // namespace reradiant
