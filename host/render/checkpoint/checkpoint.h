#pragma once

#include "host/render/film/film_sums.h"
#include "reradiant/merge.h"
#include "reradiant/render.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace reradiant {

/// A render between two passes.
struct RenderCheckpoint {
    SampleIdentity identity;
    std::vector<RenderProgress> passes; ///< not empty; the last is the state
    std::uint64_t paths = 0, rays = 0;
    std::vector<float> sums, statistics; ///< of all pixels (FilmStrip), film by film
};

/// Writes a checkpoint, atomically and synced (host/base/atomic_file.h): one line of JSON that
/// gives the sizes, the films' sums as little-endian floats, and a SHA-256 of it all. Returns the
/// bytes written; run-time Error when the disk does not take them.
std::uint64_t write_checkpoint(const std::filesystem::path& file, const RenderCheckpoint& head,
                               FilmSums films);

/// Reads a checkpoint of the render `identity` with `floats` numbers back. Input Error for a file
/// that is damaged or cut off, or that belongs to another render, naming what differs; nothing is
/// allocated before all of that is known.
RenderCheckpoint read_checkpoint(const std::filesystem::path& file, const SampleIdentity& identity,
                                 std::uint64_t floats);

} // namespace reradiant
