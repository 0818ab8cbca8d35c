#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace reradiant {

/// Scales variances of means that were taken as if samples were independent, so that on the average
/// over each tile of 16 x 16 pixels they are what the samples have: that of the difference of two
/// halves that share nothing, squared. A pixel's own spread says where it is noisy, the halves say
/// how much less noise low-discrepancy samples leave of it (host/render/film/film_sums.h).
///
/// `variances`, `squared_differences`: (height, width, channels); channels are scaled one by one.
void scale_variances(std::span<float> variances, std::span<const float> squared_differences,
                     int width, int height, std::size_t channels);

} // namespace reradiant
