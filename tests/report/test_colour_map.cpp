#include "host/report/colour_map.h"
#include "reradiant/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace reradiant;

namespace {

std::array<double, 3> lab_of(const Rgb8& colour) {
    std::array<double, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = colour[c] / 255.0;
        linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return xyz_to_lab(linear_srgb_to_xyz(linear), linear_srgb_to_xyz({1, 1, 1}));
}

/// CIEDE2000 over each sixteenth of a range of the table.
std::vector<double> steps(const ColourTable& table, std::size_t begin, std::size_t end) {
    std::vector<double> result;
    const std::size_t stride = (end - begin) / 16;
    for (std::size_t k = begin; k + stride < end; k += stride)
        result.push_back(ciede2000(lab_of(table[k]), lab_of(table[k + stride])));
    return result;
}

/// CIEDE2000 is not Oklab, in which the steps are equal: a factor of 2.2 between the largest and
/// the smallest step is their disagreement; a rainbow map has 6 and more.
void expect_uniform(const std::vector<double>& differences) {
    const auto [low, high] = std::minmax_element(differences.begin(), differences.end());
    EXPECT_LT(*high / *low, 2.2);
    EXPECT_GT(*low, 2.0); // and every sixteenth can be told from the next
}

} // namespace

TEST(ColourMap, SequentialRisesInLightnessInEqualSteps) {
    const ColourTable& table = sequential_colours();
    // Grey copies stay readable. Every fourth entry: 8 bits a channel round single steps.
    for (std::size_t k = 4; k < table.size(); k += 4)
        EXPECT_GT(lab_of(table[k])[0], lab_of(table[k - 4])[0]) << k;
    expect_uniform(steps(table, 0, 256));
}

TEST(ColourMap, DivergingIsTheSameOnBothSides) {
    const ColourTable& table = diverging_colours();
    for (std::size_t k = 0; k < 128; k += 8)
        EXPECT_NEAR(lab_of(table[k])[0], lab_of(table[255 - k])[0], 6.0) << k;
    EXPECT_GT(lab_of(table[127])[0], 95.0);
    EXPECT_EQ(table[127], table[128]); // zero has one colour
    expect_uniform(steps(table, 0, 128));
    expect_uniform(steps(table, 128, 256));
}

TEST(ColourMap, ColoursAreWrittenAsHtmlReadsThem) {
    EXPECT_EQ(hex_colour({0, 10, 255}), "#000aff");
}
