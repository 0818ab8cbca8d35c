#pragma once

#include "host/render/film/film_sums.h"

#include <cstdint>
#include <span>
#include <vector>

namespace reradiant {

/// Pixels that get so many samples more, ascending.
struct AdaptiveGroup {
    std::uint32_t samples = 0;
    std::vector<PixelSamples> pixels;
};

/// Samples that were taken of all pixels together.
std::uint64_t samples_of(FilmSums film);

/// Samples that every pixel has before their errors say where the next ones go. A comb's phases are
/// so much alike that two of each half will do; hero wavelengths have to have been everywhere.
std::uint32_t samples_before_adapting(const WavelengthPlan& plan);

/// Returns where samples lower the relMSE most. Tiles of 8 x 8 pixels double their samples, so that
/// every pixel keeps a whole net of its sequence: again and again the one that gains most per
/// sample does so, until `budget` samples are given out. The mean error of n independent samples
/// falls as 1 / n; a tile's own counts for half and that of its neighbourhood for the other half,
/// since few samples may have missed what is bright and rare. Where nothing fits the budget, the
/// first tile that fits `most` is taken.
///
/// `pixel_errors`: those of deciding_errors (host/render/film/error_estimate.h). Samples are
/// numbered from `first_sample` on. The same film gives the same groups.
std::vector<AdaptiveGroup> adaptive_groups(FilmSums film, std::span<const float> pixel_errors,
                                           int width, int height, std::uint32_t first_sample,
                                           std::uint64_t budget, std::uint64_t most);

} // namespace reradiant
