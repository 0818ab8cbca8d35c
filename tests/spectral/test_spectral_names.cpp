#include "host/spectral/spectrum/spectral_names.h"

#include <gtest/gtest.h>

namespace reradiant {

namespace {

double nm_of(std::string_view text) {
    const auto named = take_named_wavelength(text);
    return named && text.empty() ? named->nm : 0.0;
}

} // namespace

TEST(SpectralNames, WavelengthsInEveryUnitOfTheLayoutAreRead) {
    EXPECT_EQ(nm_of("380,000000nm"), 380.0);
    EXPECT_EQ(nm_of("380.5nm"), 380.5);
    EXPECT_EQ(nm_of(",5e3nm"), 500.0);
    // 1e-9: the powers of ten are rounded.
    EXPECT_NEAR(nm_of("0,38um"), 380.0, 1e-9);
    EXPECT_NEAR(nm_of("3,8E-7m"), 380.0, 1e-9);
    EXPECT_NEAR(nm_of("3.8e-10km"), 380.0, 1e-9);
    EXPECT_NEAR(nm_of("500THz"), 599.584916, 1e-9);
    EXPECT_NEAR(nm_of("0,5e+15Hz"), 599.584916, 1e-9);
    EXPECT_NEAR(nm_of("0.0005EHz"), 599.584916, 1e-9);
}

TEST(SpectralNames, RoundingIsHalfTheLastDigit) {
    std::string_view three = "374,688nm", whole = "375nm", micro = "0,3747um", hertz = "500THz";
    // 1e-12: numbers of order 1.
    EXPECT_NEAR(take_named_wavelength(three)->rounding_nm, 5e-4, 1e-12);
    EXPECT_NEAR(take_named_wavelength(whole)->rounding_nm, 0.5, 1e-12);
    EXPECT_NEAR(take_named_wavelength(micro)->rounding_nm, 0.05, 1e-12);
    // 0.5 THz of 500.
    EXPECT_NEAR(take_named_wavelength(hertz)->rounding_nm, 0.599584916, 1e-9);
}

TEST(SpectralNames, OtherTextsAreNoWavelengths) {
    for (const char* text : {"", "nm", ",nm", "380", "380 nm", "-380nm", "+380nm", "380Nm", "380xm",
                             "3,8,0nm", "nan", "1e999nm", "0nm", "1e9m", "380nmx", "0Hz"})
        EXPECT_EQ(nm_of(text), 0.0) << text;
    std::string_view two = "380nm.520nm";
    EXPECT_EQ(take_named_wavelength(two)->nm, 380.0);
    EXPECT_EQ(two, ".520nm");
}

} // namespace reradiant
