#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/fuzz_input.h"

// Scenes in TOML, with a matrix, a mesh and presets that they may name.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    [[maybe_unused]] static const bool prepared = (fuzz::put_companions(), true);
    const auto file = fuzz::put("input.toml", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] { fuzz::check_scene(load_scene(file)); });
    return 0;
}
