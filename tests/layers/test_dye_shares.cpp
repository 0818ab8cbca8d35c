#include "host/layers/stack/slab_emission.h"
#include "reradiant/reradiation.h"

#include <gtest/gtest.h>

#include <memory>

namespace reradiant {
namespace {

/// Of 400 nm all is sent out at 500 nm, of 500 nm all within the band.
SlabDye two_bands() {
    SlabDye dye;
    dye.absorption = Spectrum::constant(1.0);
    const WavelengthGrid own{400.0, 100.0, 2};
    Eigen::MatrixXd values(2, 2);
    values << 0.0, 0.0, 1.0, 1.0;
    dye.shares = std::make_shared<const ReradiationMatrix>(ReradiationMatrix{own, own, values});
    return dye;
}

TEST(DyeShares, AreAsGivenOnTheirOwnBands) {
    const SlabDye dye = two_bands();
    EXPECT_EQ(dye_shares(dye, dye.shares->emission), dye.shares->values);
}

// Cells of 20 nm from 320 to 580 nm; those of the shares reach from 350 to 550 nm. Sums of a few
// numbers: to rounding.
TEST(DyeShares, SendOutAsMuchOnFinerBandsAndNothingBeyondTheirOwn) {
    const WavelengthGrid fine{330.0, 20.0, 13};
    const Eigen::MatrixXd shares = dye_shares(two_bands(), fine);
    for (int band = 0; band < fine.count; ++band) {
        const double nm = fine.centre_nm(band);
        const double of_400 = nm == 350.0 || nm == 450.0 ? 0.5
                              : nm > 350.0 && nm < 450.0 ? 1.0
                                                         : 0.0;
        const double of_500 = nm == 450.0 || nm == 550.0 ? 0.5
                              : nm > 450.0 && nm < 550.0 ? 1.0
                                                         : 0.0;
        EXPECT_NEAR(shares.col(band).sum(), of_400 + of_500, 1e-12) << nm;
        if (of_400 == 0.0 || of_500 == 0.0) {
            EXPECT_NEAR(shares(band, band), of_500, 1e-12) << nm << ", within the band";
        }
    }
}

// One band of 200 nm holds both: what went from one to the other stays in it.
TEST(DyeShares, AddUpOnCoarserBands) {
    const Eigen::MatrixXd shares = dye_shares(two_bands(), {450.0, 200.0, 1});
    EXPECT_NEAR(shares(0, 0), 1.0, 1e-12);
}

TEST(DyeShares, SlabEmissionIsTheSumOfItsDyes) {
    Layer layer;
    layer.thickness = 2.0;
    layer.dyes = {two_bands(), two_bands()};
    layer.dyes[1].concentration = 3.0;
    const WavelengthGrid own = two_bands().shares->emission;
    EXPECT_LT((slab_emission(layer, own) - 8.0 * two_bands().shares->values).cwiseAbs().maxCoeff(),
              1e-12);
    for (SlabDye& dye : layer.dyes)
        dye.concentration = 0.0;
    EXPECT_EQ(slab_emission(layer, own).size(), 0);
}

} // namespace
} // namespace reradiant
