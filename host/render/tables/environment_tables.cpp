#include "host/render/tables/environment_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

double texel_sum(const Image& image, int row, int column) {
    const int x = (column + image.width) % image.width;
    const int y = std::clamp(row, 0, image.height - 1);
    const float* rgb = image.rgb.data() +
                       3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x));
    return static_cast<double>(rgb[0]) + static_cast<double>(rgb[1]) + static_cast<double>(rgb[2]);
}

double sine_of_row(const Image& image, int row) {
    return std::sin(std::numbers::pi * (row + 0.5) / image.height);
}

/// Mean of the bilinear interpolation over a texel: weights 1/8, 6/8, 1/8 along each axis.
double smoothed(const Image& image, int row, int column) {
    constexpr double weights[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
            sum += weights[j + 1] * weights[i + 1] * texel_sum(image, row + j, column + i);
    return sum;
}

/// Exclusive running sums over their total.
void append_cumulative(const double* values, int count, double total, std::vector<float>& tables) {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        tables.push_back(static_cast<float>(sum / total));
        sum += values[i];
    }
}

} // namespace

double mean_over_sphere(const Image& image) {
    double sum = 0.0, weight = 0.0;
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) {
            sum += texel_sum(image, row, column) / 3.0 * sine_of_row(image, row);
            weight += sine_of_row(image, row);
        }
    return sum / weight;
}

EnvironmentRecord append_environment_image(const Image& image, double rotation_deg,
                                           std::vector<float>& tables) {
    const auto columns = static_cast<std::size_t>(image.width);
    const auto rows = static_cast<std::size_t>(image.height);
    std::vector<double> shares(rows * columns), row_sums(rows, 0.0);
    double total = 0.0;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const int y = static_cast<int>(row), x = static_cast<int>(column);
            shares[row * columns + column] = smoothed(image, y, x) * sine_of_row(image, y);
            row_sums[row] += shares[row * columns + column];
        }
        total += row_sums[row];
    }
    const auto here = [&] { return static_cast<std::uint32_t>(tables.size()); };
    EnvironmentRecord record{};
    record.width = static_cast<std::uint32_t>(image.width);
    record.height = static_cast<std::uint32_t>(image.height);
    // right-handed about y: from -z towards -x, against the order of the columns
    record.rotation = static_cast<float>(-rotation_deg / 360.0);
    record.image = here();
    tables.insert(tables.end(), image.rgb.begin(), image.rgb.end());
    record.density = here();
    const double texels = static_cast<double>(rows * columns);
    for (const double share : shares)
        tables.push_back(static_cast<float>(share / total * texels));
    record.conditional = here();
    for (std::size_t row = 0; row < rows; ++row)
        append_cumulative(shares.data() + row * columns, image.width,
                          std::max(row_sums[row], 1e-300), tables);
    record.marginal = here();
    append_cumulative(row_sums.data(), image.height, total, tables);
    return record;
}

} // namespace reradiant
