#include "host/film/display/display_gamut.h"
#include "tests/film/film_fixtures.h"
#include "tests/film/saturated_colours.h"

#include <fmt/core.h>

#include <random>

namespace reradiant {

using namespace test;

namespace {

/// Red to green by the hue of CIELAB, as most of what fluoresces looks.
bool is_warm(const Xyz& xyz) {
    const auto lab = xyz_to_lab(xyz, srgb_white());
    return lab[2] > 0.0;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

double percentile_95(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() * 95 / 100];
}

} // namespace

TEST(DisplayGamut, SaturatedColoursKeepTheirHueAsClippingDoesNot) {
    const DisplayGamut gamut(srgb_primaries());
    std::vector<double> angle_clip, angle_compress, term_clip, term_compress, warm_clip,
        warm_compress;
    for (const Xyz& colour : saturated_colours()) {
        const Xyz compressed = gamut.compressed(colour);
        EXPECT_TRUE(is_in_srgb(compressed)) << colour[0] << " " << colour[1] << " " << colour[2];
        const HueError clip = hue_error(colour, clipped_to_srgb(colour)),
                       compress = hue_error(colour, compressed);
        angle_clip.push_back(clip.angle_deg);
        angle_compress.push_back(compress.angle_deg);
        term_clip.push_back(clip.term);
        term_compress.push_back(compress.term);
        if (is_warm(colour)) {
            warm_clip.push_back(clip.angle_deg);
            warm_compress.push_back(compress.angle_deg);
        }
    }
    const auto print = [](const char* what, const std::vector<double>& values) {
        fmt::print("{}: mean {:.3f}, 95 % below {:.3f}\n", what, mean(values),
                   percentile_95(values));
    };
    print("hue angle of CIELAB, clip", angle_clip);
    print("hue angle of CIELAB, compress", angle_compress);
    print("hue angle of CIELAB of red to green, clip", warm_clip);
    print("hue angle of CIELAB of red to green, compress", warm_compress);
    print("hue term of CIEDE2000, clip", term_clip);
    print("hue term of CIEDE2000, compress", term_compress);
    // The hue of IPT is not that of CIELAB, most of all in the blue, so that it is not 0. Of the
    // angle half is left, of the term, which grows with chroma, two thirds; 0.8 leaves room for
    // rounding.
    EXPECT_LT(mean(angle_compress), 0.8 * mean(angle_clip));
    EXPECT_LT(percentile_95(angle_compress), 0.8 * percentile_95(angle_clip));
    EXPECT_LT(mean(warm_compress), 0.5 * mean(warm_clip)) << "a fifth is left";
    EXPECT_LT(mean(term_compress), 0.8 * mean(term_clip));
}

TEST(DisplayGamut, NeutralAxisIsUnchanged) {
    const DisplayGamut gamut(srgb_primaries());
    for (int k = 0; k <= 1000; ++k) {
        const double grey = k / 1000.0;
        const Xyz xyz = linear_srgb_to_xyz({grey, grey, grey});
        const Xyz result = gamut.compressed(xyz);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(result[c], xyz[c], 1e-9) << grey; // a 20 millionth of an 8 bit code
    }
    const Xyz bright = gamut.compressed(linear_srgb_to_xyz({3.0, 3.0, 3.0}));
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(bright[c], srgb_white()[c], 1e-6)
            << "brighter than white is white, as by clipping";
}

TEST(DisplayGamut, ColoursWellInsideStayToTheBit) {
    const DisplayGamut gamut(srgb_primaries());
    std::mt19937 random(2);
    // Towards a grey of half the white, well within nine tenths of the way to the surface.
    std::uniform_real_distribution<double> channel(0.3, 0.5);
    for (int k = 0; k < 1000; ++k) {
        const Xyz xyz = linear_srgb_to_xyz({channel(random), channel(random), channel(random)});
        EXPECT_EQ(gamut.compressed(xyz), xyz);
    }
}

TEST(DisplayGamut, DetailThatClippingLosesStays) {
    const DisplayGamut gamut(srgb_primaries());
    // A glowing orange that gets brighter and more saturated: red is clipped throughout.
    double last_red = 0.0, last_green = 2.0;
    for (double outside = 1.1; outside < 2.0; outside += 0.1) {
        const Xyz xyz = linear_srgb_to_xyz({outside, 0.3 - 0.2 * outside, -0.1 * outside});
        EXPECT_NEAR(xyz_to_linear_srgb(clipped_to_srgb(xyz))[0], 1.0, 1e-9);
        const auto rgb = xyz_to_linear_srgb(gamut.compressed(xyz));
        EXPECT_TRUE(std::abs(rgb[0] - last_red) > 1e-4 || std::abs(rgb[1] - last_green) > 1e-4);
        last_red = rgb[0];
        last_green = rgb[1];
    }
}

TEST(DisplayGamut, BlackAndNotANumberPassThrough) {
    const DisplayGamut gamut(srgb_primaries());
    EXPECT_EQ(gamut.compressed({0.0, 0.0, 0.0}), (Xyz{0.0, 0.0, 0.0}));
    EXPECT_TRUE(std::isnan(gamut.compressed({std::nan(""), 0.1, 0.1})[0]));
    for (const double value : gamut.compressed({1e30, 1e28, 1e-30}))
        EXPECT_TRUE(std::isfinite(value));
}

} // namespace reradiant
