#include "host/scene/toml/stack_file.h"
#include "reradiant/scene_file.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/fuzz_input.h"

// Materials as `measure` takes them, model files of `fit`, and the layers alone as `fit --stack`
// does.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    [[maybe_unused]] static const bool prepared = (fuzz::put_companions(), true);
    const auto file = fuzz::put("input.toml", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] { fuzz::check_material(load_material(file)); });
    fuzz::read_or_refuse([&] { fuzz::check_stack(load_stack(file)); });
    return 0;
}
