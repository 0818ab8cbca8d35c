#pragma once

#include "host/layers/rough/specular_lobes.h"
#include "host/layers/walk/walk_random.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace reradiant {

/// Follows light once and adds the value of a lobe, without its amplitudes, towards every direction
/// that it is aimed at, 1/sr without the cosine, as expectation.
using LobeWalk = std::function<void(WalkRandom& random, std::span<double> sums)>;
/// Makes the walk of light from `own`, aimed at others. Directions are those of the lobe.
using AimedLobeWalk =
    std::function<LobeWalk(const kernels::Vec3& own, std::span<const kernels::Vec3> others)>;

/// Returns the table of kernels/scatter/lobe_ratio.h (LOBE_RATIO_SIZE, unit 1): means over walks
/// divided by the lobe of facets, `plain`, whose own table is not looked at, and 1 from the normal
/// to the normal. `key` says what the walk depends on: tables are kept under it in memory and in
/// the disk cache (cache_directory()/interfaces). Thread-safe.
std::shared_ptr<const std::vector<float>>
lobe_ratios(const LobeShape& plain, const AimedLobeWalk& aimed, const std::vector<double>& key);

/// These round what walks depend on, so that one table stands for all of a neighbourhood: an index
/// of refraction to 0.05 (0.01 below 1.1); a width or a depth to a 16th part of an octave.
double rounded_ior(double ior);
double rounded_size(double size);

/// Appends to a key what a surface does.
void append_key(const SurfaceValues& surface, std::vector<double>& key);
/// Returns a rough surface with a rounded width, media and no film; `surface` itself where the
/// media are so near to each other that it would not be rough any more.
SurfaceValues rounded(const SurfaceValues& surface);

} // namespace reradiant
