#include "host/scene/images/image_io.h"
#include "tests/fuzz/fuzz_input.h"

// Images that textures, environments and heightfields name: PNG by libpng, EXR by OpenEXR.

using namespace reradiant;

namespace {

void check_image(const Image& image) {
    if (image.width < 1 || image.height < 1 ||
        image.rgb.size() !=
            3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        fuzz::fail("an image of another size than it says");
    fuzz::require_all_finite(image.rgb, "colour of a pixel");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const auto file = fuzz::put("input.image", fuzz::text_of(bytes, size));
    const bool is_png = size > 0 && bytes[0] == 0x89;
    fuzz::read_or_refuse([&] {
        check_image(is_png ? read_png_image(file, ImageEncoding::Srgb)
                           : read_exr_image(file, ImageEncoding::Srgb));
    });
    return 0;
}
