#include "host/film/image_memory.h"

#include "host/base/memory_limit.h"
#include "host/exr/exr_input.h"
#include "host/exr/exr_window.h"
#include "host/film/exr_layout.h"
#include "host/film/spectral_channels.h"

#include <ImfChannelList.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

struct ImageSize {
    double pixels = 0.0;
    double values = 0.0; ///< floats that read_spectral_exr keeps
    double layers = 0.0; ///< those of light layers
};

ImageSize size_of(const fs::path& file) {
    return with_exr_input(file, [](Imf::MultiPartInputFile& input) {
        const ExrWindow window(input.header(0));
        ImageSize size{static_cast<double>(window.width()) * static_cast<double>(window.height()),
                       0.0, 0.0};
        for (int part = 0; part < input.parts(); ++part) {
            const Imf::Header& header = input.header(part);
            const bool is_layer =
                header.hasName() && header.name().starts_with(exr_layout::light_prefix);
            const Imf::ChannelList& channels = header.channels();
            for (auto channel = channels.begin(); channel != channels.end(); ++channel)
                if (part > 0 || band_of_channel(channel.name()))
                    (is_layer ? size.layers : size.values) += size.pixels;
        }
        return size;
    });
}

/// XYZ in double, of which several stages hold one each.
constexpr double xyz_bytes = 3 * sizeof(double);

} // namespace

void check_compare_memory(const fs::path& image, const fs::path& reference,
                          std::uint64_t limit_bytes) {
    double bytes = 0.0;
    for (const fs::path& file : {image, reference}) {
        const ImageSize size = size_of(file);
        bytes += size.values * sizeof(float) + 2 * size.pixels * xyz_bytes;
    }
    check_memory_limit({image.string()}, "the comparison", bytes, limit_bytes,
                       "crop the images, take fewer bands");
}

void check_merge_memory(const std::vector<fs::path>& parts, std::uint64_t limit_bytes) {
    for (const fs::path& part : parts) {
        const ImageSize size = size_of(part);
        // The first part, one more and the mean; sum and sum of squares of every value. Of layers
        // sum and mean; the one that is read takes less than the image, which is gone by then.
        const double bytes = size.values * (3 * sizeof(float) + 2 * sizeof(double)) +
                             size.layers * (sizeof(float) + sizeof(double)) +
                             2 * size.pixels * xyz_bytes;
        check_memory_limit({part.string()}, "merging this", bytes, limit_bytes,
                           "render with fewer bands");
    }
}

} // namespace reradiant
