#include "reradiant/merge.h"

#include "host/film/colour_image.h"
#include "reradiant/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& file, const std::string& wrong,
                         const std::string& remedy) {
    throw_input_error({file.string()}, wrong, remedy);
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(at), text.size());
        pieces.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return pieces;
}

std::optional<std::uint32_t> whole_number(std::string_view text) {
    std::uint32_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    return code == std::errc{} && end == text.data() + text.size() ? std::optional(value)
                                                                   : std::nullopt;
}

std::vector<SampleRange> parse_ranges(const fs::path& file, const std::string& text) {
    std::vector<SampleRange> ranges;
    for (const std::string_view piece : split(text, ',')) {
        const auto ends = split(piece, ':');
        const auto first = ends.size() == 2 ? whole_number(ends[0]) : std::nullopt;
        const auto end = ends.size() == 2 ? whole_number(ends[1]) : std::nullopt;
        if (!first || !end || *first >= *end)
            refuse(file, fmt::format("its sample ranges '{}' are damaged", text),
                   "render the part again");
        ranges.push_back({*first, *end});
    }
    return ranges;
}

SampleIdentity parse_identity(const std::string& text) {
    SampleIdentity identity;
    for (const std::string_view line : split(text, '\n')) {
        const std::size_t equals = std::min(line.find('='), line.size());
        identity.emplace_back(line.substr(0, equals),
                              line.substr(std::min(equals + 1, line.size())));
    }
    return identity;
}

/// A `PartHead` holds what the attributes of a part say about its samples.
struct PartHead {
    fs::path file;
    std::vector<SampleRange> ranges;
    SampleIdentity identity;
};

PartHead head_of(const fs::path& file, const SpectralImage& image) {
    const auto ranges = image.attributes.find(sample_ranges_attribute);
    const auto sampling = image.attributes.find(sampling_attribute);
    constexpr const char* remedy = "merge images as `reradiant render --sample-range` writes them";
    if (ranges == image.attributes.end() || sampling == image.attributes.end())
        refuse(file, "does not say which samples of which render it holds", remedy);
    if (image.sample_count.empty())
        refuse(file, "has no sample counts", remedy);
    PartHead head{file, parse_ranges(file, ranges->second), parse_identity(sampling->second)};
    if (head.ranges.empty())
        refuse(file, "holds no samples", remedy);
    return head;
}

/// All ranges in ascending order; the gaps between them. Refuses samples that two parts hold.
std::vector<SampleRange> gaps_between(const std::vector<PartHead>& heads,
                                      std::vector<SampleRange>& all) {
    std::vector<std::pair<SampleRange, const PartHead*>> owned;
    for (const PartHead& head : heads)
        for (const SampleRange& range : head.ranges)
            owned.emplace_back(range, &head);
    std::sort(owned.begin(), owned.end(),
              [](const auto& a, const auto& b) { return a.first.first < b.first.first; });
    std::vector<SampleRange> gaps;
    for (std::size_t k = 0; k < owned.size(); ++k) {
        const SampleRange& range = owned[k].first;
        if (k > 0 && range.first < all.back().end)
            refuse(owned[k].second->file,
                   fmt::format("samples {} to {} are in {} too", range.first,
                               std::min(range.end, all.back().end) - 1,
                               owned[k - 1].second->file.string()),
                   "merge each part once, of ranges that do not overlap");
        if (k > 0 && range.first > all.back().end)
            gaps.push_back({all.back().end, range.first});
        if (k > 0 && range.first == all.back().end)
            all.back().end = range.end;
        else
            all.push_back(range);
    }
    return gaps;
}

void check_alike(const fs::path& file, const SpectralImage& part, const SpectralImage& first) {
    if (part.width != first.width || part.height != first.height || part.left != first.left ||
        part.top != first.top || part.bands.count != first.bands.count ||
        part.bands.from_nm != first.bands.from_nm || part.bands.step_nm != first.bands.step_nm ||
        part.variance_bands.size() != first.variance_bands.size())
        refuse(file, "has another size or other bands than the first part",
               "merge parts of one render");
}

/// Sums over all samples of one quantity, from the means and variances of parts.
struct Moments {
    double sum = 0.0, squares = 0.0;

    /// `variance` is that of the part's mean.
    void add(double n, double mean, double variance) {
        sum += n * mean;
        squares += n * (n - 1.0) * variance + n * mean * mean;
    }
    double variance_of_mean(double n) const {
        const double mean = sum / n;
        return n < 2.0 ? 0.0 : std::max(0.0, squares / n - mean * mean) / (n - 1.0);
    }
};

/// Sums of the parts, in double.
class Accumulator {
public:
    explicit Accumulator(const SpectralImage& first)
        : first_(first), count_(first.sample_count.size()), y_(count_.size()),
          bands_(first.values.size()) {}

    void add(const SpectralImage& part) {
        const std::vector<Xyz> xyz = xyz_image(part);
        const auto bands = static_cast<std::size_t>(part.bands.count);
        const bool has_bands = !part.variance_bands.empty(), has_y = !part.variance_y.empty();
        for (std::size_t pixel = 0; pixel < count_.size(); ++pixel) {
            const double n = part.sample_count[pixel];
            count_[pixel] += n;
            y_[pixel].add(n, xyz[pixel][1], has_y ? part.variance_y[pixel] : 0.0);
            for (std::size_t i = pixel * bands; i < (pixel + 1) * bands; ++i)
                bands_[i].add(n, part.values[i], has_bands ? part.variance_bands[i] : 0.0);
        }
    }

    SpectralImage mean() const {
        SpectralImage image = first_;
        const auto bands = static_cast<std::size_t>(image.bands.count);
        for (std::size_t pixel = 0; pixel < count_.size(); ++pixel) {
            const double n = std::max(count_[pixel], 1.0);
            image.sample_count[pixel] = static_cast<float>(count_[pixel]);
            if (!image.variance_y.empty())
                image.variance_y[pixel] = static_cast<float>(y_[pixel].variance_of_mean(n));
            for (std::size_t i = pixel * bands; i < (pixel + 1) * bands; ++i) {
                image.values[i] = static_cast<float>(bands_[i].sum / n);
                if (!image.variance_bands.empty())
                    image.variance_bands[i] = static_cast<float>(bands_[i].variance_of_mean(n));
            }
        }
        return image;
    }

private:
    const SpectralImage& first_;
    std::vector<double> count_;
    std::vector<Moments> y_, bands_;
};

/// Sums of the parts' light layers, in double.
class LayerAccumulator {
public:
    void add(const fs::path& file, const SpectralImage& part) {
        std::size_t k = 0;
        const bool is_first = layers_.empty();
        read_light_layers(file, [&](LightLayer&& layer) {
            if (is_first) {
                sums_.emplace_back(layer.values.size());
                layers_.push_back(layer);
                layers_.back().values.clear();
            }
            if (k == layers_.size() || layers_[k].name() != layer.name() ||
                sums_[k].size() != layer.values.size())
                refuse(file, "has other light groups than the first part",
                       "merge parts of one render");
            const auto bands = static_cast<std::size_t>(part.bands.count);
            for (std::size_t i = 0; i < layer.values.size(); ++i)
                sums_[k][i] += static_cast<double>(part.sample_count[i / bands]) *
                               static_cast<double>(layer.values[i]);
            ++k;
        });
        if (k != layers_.size())
            refuse(file, "lacks light groups of the first part", "merge parts of one render");
    }

    /// `mean` holds the counts of all samples.
    std::vector<LightLayer> means(const SpectralImage& mean) {
        const auto bands = static_cast<std::size_t>(mean.bands.count);
        for (std::size_t k = 0; k < layers_.size(); ++k)
            for (std::size_t i = 0; i < sums_[k].size(); ++i)
                layers_[k].values.push_back(static_cast<float>(
                    sums_[k][i] /
                    std::max(static_cast<double>(mean.sample_count[i / bands]), 1.0)));
        return std::move(layers_);
    }

private:
    std::vector<LightLayer> layers_;
    std::vector<std::vector<double>> sums_;
};

} // namespace

std::optional<std::string> identity_difference(const SampleIdentity& now,
                                               const SampleIdentity& then) {
    for (std::size_t k = 0; k < std::max(now.size(), then.size()); ++k) {
        if (k >= now.size() || k >= then.size() || now[k].first != then[k].first)
            return "it was written by another version";
        if (now[k].second != then[k].second)
            return fmt::format("the {} is {}, not {}", now[k].first, now[k].second, then[k].second);
    }
    return std::nullopt;
}

std::string sample_ranges_text(const std::vector<SampleRange>& ranges) {
    std::vector<std::string> texts;
    for (const SampleRange& range : ranges)
        texts.push_back(fmt::format("{}:{}", range.first, range.end));
    return fmt::format("{}", fmt::join(texts, ","));
}

std::string identity_text(const SampleIdentity& identity) {
    std::string text;
    for (const auto& [name, value] : identity)
        text += fmt::format("{}={}\n", name, value);
    return text;
}

MergedImage merge_images(const std::vector<fs::path>& parts) {
    std::vector<PartHead> heads;
    for (const fs::path& part : parts)
        heads.push_back(head_of(part, read_spectral_exr(part)));
    std::sort(heads.begin(), heads.end(), [](const PartHead& a, const PartHead& b) {
        return a.ranges.front().first < b.ranges.front().first;
    });
    for (const PartHead& head : heads)
        if (const auto difference = identity_difference(head.identity, heads.front().identity))
            refuse(head.file,
                   fmt::format("is of another render than {}: {}", heads.front().file.string(),
                               *difference),
                   "merge parts of one render");
    std::vector<SampleRange> ranges;
    MergedImage merged;
    merged.gaps = gaps_between(heads, ranges);
    const SpectralImage first = read_spectral_exr(heads.front().file);
    Accumulator sums(first);
    LayerAccumulator layers;
    for (const PartHead& head : heads) {
        const SpectralImage part = read_spectral_exr(head.file);
        check_alike(head.file, part, first);
        sums.add(part);
        layers.add(head.file, part);
    }
    merged.image = sums.mean();
    merged.light_layers = layers.means(merged.image);
    std::uint64_t samples = 0;
    for (const SampleRange& range : ranges)
        samples += range.end - range.first;
    merged.image.attributes[sample_ranges_attribute] = sample_ranges_text(ranges);
    merged.image.attributes["reradiant:samples"] = std::to_string(samples);
    merged.image.attributes["reradiant:firstSample"] = std::to_string(ranges.front().first);
    merged.image.attributes.erase("reradiant:renderIdentity");
    return merged;
}

} // namespace reradiant
