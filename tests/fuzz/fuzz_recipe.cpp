#include "reradiant/synth.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/fuzz_input.h"

// Recipes of synthetic data.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    [[maybe_unused]] static const bool prepared = (fuzz::put_companions(), true);
    const auto file = fuzz::put("input.toml", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const SynthRecipe recipe = read_synth_recipe(file);
        fuzz::check_stack(recipe.stack);
        fuzz::check_spectrum(recipe.reflectance);
        fuzz::require_finite(recipe.emission.to_nm(), "emission grid");
        fuzz::require_finite(recipe.excitation.to_nm(), "excitation grid");
    });
    return 0;
}
