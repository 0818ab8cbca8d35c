#include "host/render/film/team_film.h"

#include <bit>
#include <vector>

namespace reradiant {

namespace {

/// One pixel's floats, in order, as kernels/film.cl keeps them: a sum and its compensation, which
/// lie `apart` from each other, become one double.
struct PixelNumbers {
    std::size_t lanes, rows;

    std::size_t doubles() const { return lanes * (rows - 1) + 4; }

    void read(const float* sums, const float* statistics, double* numbers) const {
        const auto compensated = [](const float* from, std::size_t apart) {
            return static_cast<double>(from[0]) - static_cast<double>(from[apart]);
        };
        for (std::size_t lane = 0; lane < lanes; ++lane)
            *numbers++ = compensated(sums + lane, lanes);
        for (std::size_t i = 2 * lanes; i < rows * lanes; ++i)
            *numbers++ = static_cast<double>(sums[i]);
        *numbers++ = compensated(statistics, 2);
        *numbers++ = compensated(statistics + 1, 2);
        *numbers++ = static_cast<double>(statistics[4]);
        *numbers = std::bit_cast<std::uint32_t>(statistics[5]);
    }

    void write(const double* numbers, float* sums, float* statistics) const {
        const auto compensated = [](double number, float* to, std::size_t apart) {
            to[0] = static_cast<float>(number);
            to[apart] = static_cast<float>(static_cast<double>(to[0]) - number);
        };
        for (std::size_t lane = 0; lane < lanes; ++lane)
            compensated(*numbers++, sums + lane, lanes);
        for (std::size_t i = 2 * lanes; i < rows * lanes; ++i)
            sums[i] = static_cast<float>(*numbers++);
        compensated(*numbers++, statistics, 2);
        compensated(*numbers++, statistics + 1, 2);
        statistics[4] = static_cast<float>(*numbers++);
        statistics[5] = std::bit_cast<float>(static_cast<std::uint32_t>(*numbers));
    }
};

/// Pixels whose numbers cross the network at a time: few enough to need little memory.
constexpr std::size_t pixels_at_once = 16384;

} // namespace

void add_films(DeviceFilm& film, const FilmLayout& layout, Team& team) {
    const PixelNumbers pixel{static_cast<std::size_t>(layout.lanes),
                             static_cast<std::size_t>(layout.rows())};
    std::vector<double> numbers;
    film.change([&](std::span<float> sums, std::span<float> statistics) {
        const std::size_t pixels = statistics.size() / film_statistics_per_pixel;
        for (std::size_t first = 0; first < pixels; first += pixels_at_once) {
            const std::size_t end = std::min(pixels, first + pixels_at_once);
            numbers.assign((end - first) * pixel.doubles(), 0.0);
            for (std::size_t p = first; p < end; ++p)
                pixel.read(&sums[p * layout.floats_per_pixel()],
                           &statistics[p * film_statistics_per_pixel],
                           &numbers[(p - first) * pixel.doubles()]);
            team.add_at_leader(numbers);
            if (!team.leads())
                numbers.assign(numbers.size(), 0.0);
            for (std::size_t p = first; p < end; ++p)
                pixel.write(&numbers[(p - first) * pixel.doubles()],
                            &sums[p * layout.floats_per_pixel()],
                            &statistics[p * film_statistics_per_pixel]);
        }
    });
}

} // namespace reradiant
