#include "host/render/film/device_film.h"

#include "host/device/opencl_device.h"
#include "reradiant/error.h"

#include <algorithm>
#include <deque>

namespace reradiant {

namespace {

constexpr std::size_t strip_bytes = std::size_t{64} << 20;

} // namespace

DeviceFilm::DeviceFilm(const Device& device, const FilmLayout& layout, std::uint32_t pixels)
    : device_(&device), pixels_(pixels), floats_per_pixel_(layout.floats_per_pixel()) {
    check_memory(device, bytes());
    const std::size_t units = std::max<std::size_t>(
        1, strip_bytes / (floats_per_pixel_ * sizeof(float) * film_strip_unit));
    const auto together = static_cast<std::uint32_t>(units * film_strip_unit);
    for (std::uint32_t first = 0; first < pixels; first += together) {
        const std::uint32_t count = std::min(together, pixels - first);
        strips_.push_back({first,
                           count,
                           {device, count * floats_per_pixel_},
                           {device, count * film_statistics_per_pixel}});
        strips_.back().sums.fill_zero();
        strips_.back().statistics.fill_zero();
    }
}

void DeviceFilm::read(const std::function<void(FilmSums)>& use) const {
    opencl_checked("reading the film", [&] {
        std::deque<DeviceArray<float>::Mapping> mappings; // they cannot be moved
        const auto mapped = [&](const DeviceArray<float>& array) {
            return std::span<const float>(
                mappings.emplace_back(array, 0, array.size(), CL_MAP_READ).span());
        };
        std::vector<FilmStrip> film;
        for (const Strip& strip : strips_)
            film.push_back({strip.first_pixel, mapped(strip.sums), mapped(strip.statistics)});
        use(film);
    });
}

void DeviceFilm::change(
    const std::function<void(std::span<float>, std::span<float>)>& change) const {
    opencl_checked("changing the film", [&] {
        for (const Strip& strip : strips_) {
            constexpr cl_map_flags both = CL_MAP_READ | CL_MAP_WRITE;
            const auto sums = strip.sums.map(both, 0, strip.sums.size());
            const auto statistics = strip.statistics.map(both, 0, strip.statistics.size());
            change(sums.span(), statistics.span());
        }
    });
}

void DeviceFilm::take(const std::function<void(const FilmStrip&)>& use) {
    opencl_checked("reading the film", [&] {
        for (Strip& strip : strips_) {
            {
                const auto sums = strip.sums.map(CL_MAP_READ, 0, strip.sums.size());
                const auto statistics =
                    strip.statistics.map(CL_MAP_READ, 0, strip.statistics.size());
                use({strip.first_pixel, sums.span(), statistics.span()});
            }
            device_->opencl().queue.finish(); // or the mapping would keep the memory
            strip.sums = {};
            strip.statistics = {};
        }
    });
}

void DeviceFilm::restore(std::span<const float> sums, std::span<const float> statistics) const {
    if (sums.size() != pixels_ * floats_per_pixel_ ||
        statistics.size() != pixels_ * film_statistics_per_pixel)
        throw_runtime_error("the film that is restored has another size");
    const auto copy = [](const DeviceArray<float>& array, std::span<const float> from) {
        const auto mapping = array.map(CL_MAP_WRITE, 0, array.size());
        std::copy(from.begin(), from.end(), mapping.span().begin());
    };
    opencl_checked("restoring the film", [&] {
        for (const Strip& strip : strips_) {
            copy(strip.sums,
                 sums.subspan(strip.first_pixel * floats_per_pixel_, strip.sums.size()));
            copy(strip.statistics, statistics.subspan(strip.first_pixel * film_statistics_per_pixel,
                                                      strip.statistics.size()));
        }
    });
}

std::size_t DeviceFilm::float_count() const {
    return pixels_ * (floats_per_pixel_ + film_statistics_per_pixel);
}

void read_films(std::span<const DeviceFilm> films, const std::function<void(FilmSums)>& use) {
    if (films.size() == 1) {
        films.front().read(use);
        return;
    }
    films.front().read([&](FilmSums first) {
        read_films(films.subspan(1), [&](FilmSums others) {
            std::vector<FilmStrip> all(first.begin(), first.end());
            all.insert(all.end(), others.begin(), others.end());
            use(all);
        });
    });
}

} // namespace reradiant
