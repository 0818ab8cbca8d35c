#pragma once

#include "reradiant/spectral_image.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace reradiant {

/// Samples first .. end - 1 of every pixel.
struct SampleRange {
    std::uint32_t first = 0, end = 0;

    bool operator==(const SampleRange&) const = default;
};

/// Facts by name that decide which samples a render takes
/// (host/render/checkpoint/render_identity.h).
using SampleIdentity = std::vector<std::pair<std::string, std::string>>;

/// "the seed is A, not B" for the first fact that differs; nothing when all agree.
std::optional<std::string> identity_difference(const SampleIdentity& now,
                                               const SampleIdentity& then);

/// Attributes of images: the ranges "A:B,C:D" that a part holds, and its identity, "name=value"
/// lines.
inline constexpr const char* sample_ranges_attribute = "reradiant:sampleRanges";
inline constexpr const char* sampling_attribute = "reradiant:sampling";
std::string sample_ranges_text(const std::vector<SampleRange>& ranges);
std::string identity_text(const SampleIdentity& identity);

struct MergedImage {
    SpectralImage image;
    std::vector<LightLayer> light_layers; ///< where the parts hold them
    std::vector<SampleRange> gaps;        ///< between the first and the last sample
};

/// The mean over all samples of partial renders of one scene: values weighted by each pixel's
/// sample count, summed in double in the order of their samples, so that the order of the files
/// does not matter. Variances follow from the parts' own and from the spread between them. At most
/// one part is in memory at a time. Input Error, naming the file, for parts of different renders,
/// sizes or bands, for samples that two parts hold, and for images without these attributes.
MergedImage merge_images(const std::vector<std::filesystem::path>& parts);

} // namespace reradiant
