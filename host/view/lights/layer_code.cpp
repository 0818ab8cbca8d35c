#include "host/view/lights/layer_code.h"

#include "host/spectral/matrix/singular_values.h"
#include "host/view/packed_text.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

constexpr double basis_tolerance = 1e-3;
constexpr int most_rank = 16;
/// Rows that the basis is found from are this many at most, spread over the picture.
constexpr std::size_t most_rows = 1 << 17;
constexpr double split_nm = 400.0;

/// The bands of a code within the values of a layer.
struct BandView {
    std::span<const float> values;
    std::size_t stride, first, count;

    std::size_t pixels() const { return values.size() / stride; }
    Eigen::VectorXd at(std::size_t pixel) const {
        Eigen::VectorXd spectrum(static_cast<Eigen::Index>(count));
        for (std::size_t b = 0; b < count; ++b)
            spectrum[static_cast<Eigen::Index>(b)] =
                static_cast<double>(values[pixel * stride + first + b]);
        return spectrum;
    }
    bool is_dark() const {
        for (std::size_t pixel = 0; pixel < pixels(); ++pixel)
            for (std::size_t b = 0; b < count; ++b)
                if (values[pixel * stride + first + b] != 0.0f)
                    return false;
        return true;
    }
};

/// The leading singular vectors of the pixels' directions: dark pixels count as much as bright
/// ones.
Eigen::MatrixXd basis_of(const BandView& view) {
    const auto n = static_cast<Eigen::Index>(view.count);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
    const std::size_t step = std::max<std::size_t>(1, view.pixels() / most_rows);
    for (std::size_t pixel = 0; pixel < view.pixels(); pixel += step) {
        const Eigen::VectorXd spectrum = view.at(pixel);
        if (const double square = spectrum.squaredNorm(); square > 0.0)
            gram.noalias() += spectrum * spectrum.transpose() / square;
    }
    const ThinSvd svd = thin_svd(gram);
    double left = svd.s.sum();
    const double allowed = basis_tolerance * basis_tolerance * left;
    Eigen::Index rank = 0;
    while (rank < std::min<Eigen::Index>(n, most_rank) && left > allowed)
        left -= svd.s[rank++];
    return svd.v.leftCols(rank).transpose();
}

/// The range of lengths that codes hold: longer ones would need more than 16 bits.
constexpr double widest_log = LayerCode::length_step * 65000.0;

void code_pixels(const BandView& view, const Eigen::MatrixXd& basis, LayerCode& code) {
    std::vector<double> longest(view.pixels());
    tbb::parallel_for(std::size_t{0}, view.pixels(),
                      [&](std::size_t p) { longest[p] = (basis * view.at(p)).norm(); });
    const double most = *std::max_element(longest.begin(), longest.end());
    double least = most;
    for (const double length : longest)
        if (length > 0.0)
            least = std::min(least, length);
    code.log_low = std::max(std::log(least), std::log(most) - widest_log);
    code.lengths.resize(view.pixels());
    code.directions.resize(view.pixels() * static_cast<std::size_t>(code.rank));
    tbb::parallel_for(std::size_t{0}, view.pixels(), [&](std::size_t p) {
        if (!(longest[p] > 0.0))
            return;
        const double place = (std::log(longest[p]) - code.log_low) / LayerCode::length_step;
        code.lengths[p] = static_cast<std::uint16_t>(1 + std::lround(std::max(place, 0.0)));
        const Eigen::VectorXd direction = basis * view.at(p) / longest[p];
        for (int k = 0; k < code.rank; ++k)
            code.directions[static_cast<std::size_t>(k) * view.pixels() + p] =
                static_cast<std::int16_t>(std::lround(direction[k] / LayerCode::direction_step));
    });
}

void find_errors(const BandView& view, LayerCode& code) {
    double squares = 0.0, count = 0.0;
    for (std::size_t p = 0; p < view.pixels(); ++p) {
        const Eigen::VectorXd truth = view.at(p);
        const std::vector<double> coded = code.spectrum(p);
        const double length = truth.norm();
        if (!(length > 0.0))
            continue;
        const double off =
            (Eigen::Map<const Eigen::VectorXd>(coded.data(), truth.size()) - truth).norm() / length;
        squares += off * off;
        count += 1.0;
        code.worst_error = std::max(code.worst_error, off);
    }
    code.rms_error = count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

LayerCode coded(const BandView& view) {
    LayerCode code;
    const Eigen::MatrixXd basis = basis_of(view);
    code.first_band = static_cast<int>(view.first);
    code.bands = static_cast<int>(view.count);
    code.rank = static_cast<int>(basis.rows());
    for (Eigen::Index k = 0; k < basis.rows(); ++k)
        for (Eigen::Index b = 0; b < basis.cols(); ++b)
            code.basis.push_back(static_cast<float>(basis(k, b)));
    code_pixels(view, basis, code);
    find_errors(view, code);
    return code;
}

/// Appends the differences of successive numbers: all their high bytes, then all low ones.
/// Differences of either sign become even and odd numbers, so that small ones have a high byte of
/// 0.
template <typename Number>
void append_differences(std::span<const Number> numbers, std::string& bytes) {
    const std::size_t at = bytes.size();
    bytes.resize(at + 2 * numbers.size());
    Number before = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto difference = static_cast<std::int16_t>(numbers[i] - before);
        const auto folded = static_cast<std::uint16_t>((difference * 2) ^ (difference >> 15));
        bytes[at + i] = static_cast<char>(folded >> 8);
        bytes[at + numbers.size() + i] = static_cast<char>(folded & 0xff);
        before = numbers[i];
    }
}

} // namespace

std::vector<double> LayerCode::spectrum(std::size_t pixel) const {
    std::vector<double> values(static_cast<std::size_t>(bands), 0.0);
    if (lengths[pixel] == 0)
        return values;
    const double length = std::exp(log_low + (lengths[pixel] - 1) * length_step) * direction_step;
    for (std::size_t k = 0; k < static_cast<std::size_t>(rank); ++k) {
        const double factor = length * directions[k * lengths.size() + pixel];
        for (std::size_t b = 0; b < values.size(); ++b)
            values[b] += factor * static_cast<double>(basis[k * values.size() + b]);
    }
    return values;
}

std::vector<LayerCode> layer_codes(std::span<const float> values, const WavelengthGrid& bands) {
    const auto count = static_cast<std::size_t>(bands.count);
    std::size_t split = 0;
    while (split < count && bands.centre_nm(static_cast<int>(split)) < split_nm)
        ++split;
    std::vector<LayerCode> codes;
    for (const auto& [first, end] : {std::pair{std::size_t{0}, split}, std::pair{split, count}})
        if (const BandView view{values, count, first, end - first}; !view.is_dark())
            codes.push_back(coded(view));
    return codes;
}

std::string packed(const LayerCode& code) {
    std::string bytes;
    append_differences<std::uint16_t>(code.lengths, bytes);
    const std::span<const std::int16_t> directions = code.directions;
    for (std::size_t k = 0; k < static_cast<std::size_t>(code.rank); ++k)
        append_differences(directions.subspan(k * code.lengths.size(), code.lengths.size()), bytes);
    return packed_text(bytes);
}

} // namespace reradiant
