#include "reradiant/spectral_image.h"
#include "tests/fuzz/fuzz_input.h"

// Spectral images with their statistics. Values may be NaN, as other programs may have written
// them; sizes may not lie.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const auto file = fuzz::put("input.exr", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const SpectralImage image = read_spectral_exr(file);
        const auto pixels =
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
        if (pixels == 0 ||
            image.values.size() != pixels * static_cast<std::size_t>(image.bands.count))
            fuzz::fail("an image of another size than it says");
        if (!image.sample_count.empty() && image.sample_count.size() != pixels)
            fuzz::fail("sample counts of another size than the image");
        fuzz::require_finite(image.bands.to_nm(), "last band");
    });
    return 0;
}
