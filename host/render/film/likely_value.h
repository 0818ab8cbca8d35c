#pragma once

#include <cstddef>
#include <span>

namespace reradiant {

/// What is known of a pixel's true value in one band: its mean, and half the difference of its two
/// halves' means.
struct SeenValue {
    double value = 0.0, difference = 0.0;
};

/// Most neighbours that a pixel has.
constexpr std::size_t most_neighbours = 8;

/// True where the halves agree so well that the mean can stand for the truth.
inline bool halves_agree(SeenValue seen) {
    return seen.difference * seen.difference <= 0.01 * seen.value * seen.value;
}

/// True where most of the light lies in one half: what the truth is can then only be guessed.
inline bool is_counted(SeenValue seen) {
    return seen.value > 0.0 && seen.difference * seen.difference > 0.25 * seen.value * seen.value;
}

/// Returns the expectation of 1 / (truth^2 + floor), given a pixel whose halves do not agree, and
/// its neighbours. Where the halves differ by less than the mean, the truth is likely to be between
/// the neighbours' mean and the pixel's. Where most of the light is in one half, few samples found
/// something bright, as at the edge of a highlight, or one that is not worth its weight; both look
/// alike, and only the neighbours' range tells them apart. There any truth in that range is taken
/// as equally likely before the samples were seen, and light to be found as counts are.
double expected_inverse_square(SeenValue seen, std::span<const SeenValue> neighbours, double floor);

} // namespace reradiant
