#include "host/check/check.h"
#include "tests/fuzz/fuzz_input.h"

// This target reads results as `check --save` keeps them, and compares them with a report like that
// of the corpus.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const auto file = fuzz::put("results.json", fuzz::text_of(bytes, size));
    CheckReport report;
    for (const char* name : {"fresnel", "sample_ggx"}) {
        FunctionReport& function = report.functions.emplace_back();
        function.name = name;
        function.sample = {{0.5f, 0.25f}, {1e-7f, 1e-7f}};
    }
    fuzz::read_or_refuse([&] { compare_results(read_saved_results(file), report); });
    return 0;
}
