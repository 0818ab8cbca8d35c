#include "host/film/spectral_channels.h"

#include <gtest/gtest.h>

#include <clocale>
#include <locale>

namespace reradiant {

namespace {

double nm_of(const char* name) {
    const auto named = band_of_channel(name);
    return named ? named->nm : 0.0;
}

} // namespace

/// A locale whose decimal sign is a comma and which groups digits, made here because none need
/// be installed.
struct CommaNumbers : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(SpectralChannels, Case35NameIsTheSameUnderAnyLocale) {
    const std::locale before = std::locale::global(std::locale(std::locale(), new CommaNumbers));
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8"); // has no effect where it is not installed
    EXPECT_EQ(spectral_channel_name(380.0), "S0.380,000000nm");
    EXPECT_EQ(spectral_channel_name(1380.5), "S0.1380,500000nm");
    EXPECT_EQ(nm_of("S0.380,000000nm"), 380.0);
    EXPECT_EQ(nm_of("S0.405,25nm"), 405.25);
    std::setlocale(LC_NUMERIC, "C");
    std::locale::global(before);
}

TEST(SpectralChannels, OtherNamesAreNoSpectralChannels) {
    for (const char* name : {"", "R", "S0", "S0.nm", "S0.380", "S1.380,000000nm", "S0.38x0nm",
                             "S0.-380,0nm", "S0.nannm", "S0.infnm", "S0.1e999nm", "S0. 380nm",
                             "T.380,000000nm", "S0.380,000,000nm", "S0.0nm"})
        EXPECT_FALSE(band_of_channel(name)) << name;
}

} // namespace reradiant
