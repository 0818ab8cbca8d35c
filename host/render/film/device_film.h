#pragma once

#include "host/device/buffer.h"
#include "host/render/film/film_sums.h"
#include "reradiant/device.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace reradiant {

/// The film's sums on the device, in strips of successive pixels: few enough for any device's
/// largest buffer, and a strip's memory goes back while the image takes its own.
class DeviceFilm {
public:
    struct Strip {
        std::uint32_t first_pixel, pixels;
        DeviceArray<float> sums, statistics;
    };

    DeviceFilm() = default;
    /// Zero everywhere. Run-time Error when the device has not the memory.
    DeviceFilm(const Device& device, const FilmLayout& layout, std::uint32_t pixels);

    const std::vector<Strip>& strips() const { return strips_; }
    /// Calls `use` with the sums as they are on the device, mapped for the call.
    void read(const std::function<void(FilmSums)>& use) const;
    /// Calls `change` with the sums and statistics of one strip after the other.
    void change(const std::function<void(std::span<float>, std::span<float>)>& change) const;
    /// Calls `use` with one strip after the other and frees its memory. Nothing can be rendered
    /// afterwards.
    void take(const std::function<void(const FilmStrip&)>& use);
    /// Replaces the sums by those of an earlier render, of all pixels; their sizes must be the
    /// film's.
    void restore(std::span<const float> sums, std::span<const float> statistics) const;
    /// Numbers that sums and statistics hold together.
    std::size_t float_count() const;
    std::size_t bytes() const { return float_count() * sizeof(float); }

private:
    const Device* device_ = nullptr;
    std::size_t pixels_ = 0, floats_per_pixel_ = 0;
    std::vector<Strip> strips_;
};

/// Calls `use` with the sums of several films, one film after the other, mapped for the call.
void read_films(std::span<const DeviceFilm> films, const std::function<void(FilmSums)>& use);

} // namespace reradiant
