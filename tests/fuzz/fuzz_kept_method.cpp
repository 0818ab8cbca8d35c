#include "host/study/converge/converge_store.h"
#include "tests/fuzz/fuzz_input.h"

#include <cmath>

// This target reads what an earlier `converge` kept of a method: it is taken whole or not at all,
// and never an error.

using namespace reradiant;

namespace {

void check(const std::vector<CurveRow>& rows) {
    double seconds = 0.0;
    for (const CurveRow& row : rows) {
        fuzz::require_finite(row.error.relmse, "an error");
        fuzz::require_finite(row.seconds_with_setup, "seconds");
        if (!(row.seconds > seconds) || std::isnan(row.estimate.value))
            fuzz::fail("seconds that do not grow, or an estimate of NaN");
        seconds = row.seconds;
    }
}

/// The one image that its methods have.
void keep_image(const RenderMethod& method) {
    MethodResult result;
    result.curve.method = method;
    result.image.bands = {400.0, 100.0, 2};
    result.image.width = result.image.height = 1;
    result.image.values = {1.0f, 2.0f};
    keep_method(fuzz::folder(), "identity", result);
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const RenderMethod method = [] {
        RenderMethod one;
        one.name = "auto";
        keep_image(one);
        return one;
    }();
    const std::string_view text = fuzz::text_of(bytes, size);
    fuzz::put("methods/auto.json", text);
    fuzz::put("methods/auto.rows.json", text);
    try {
        check(kept_rows(fuzz::folder(), "identity", method));
        if (const auto kept = kept_method(fuzz::folder(), "identity", method)) {
            check(kept->curve.rows);
            if (kept->curve.rows.empty() || kept->image.values.size() != 2)
                fuzz::fail("a method without rows or without its image");
        }
    } catch (const std::exception& error) {
        fuzz::fail(std::string("an exception instead of nothing: ") + error.what());
    }
    return 0;
}
