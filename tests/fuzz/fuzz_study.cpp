#include "host/study/study/study_file.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/fuzz_input.h"

// Studies over the small scene beside them.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    [[maybe_unused]] static const bool prepared = (fuzz::put_companions(), true);
    const auto file = fuzz::put("input.toml", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const Study study = load_study(file);
        if (study.cell_count() < 1 || study.cell_count() > most_study_cells)
            fuzz::fail("a study of too many cells, or none");
    });
    return 0;
}
