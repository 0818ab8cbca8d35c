#include "host/render/checkpoint/checkpoint.h"
#include "tests/fuzz/digested_input.h"

// Checkpoints of a render.

using namespace reradiant;

namespace {

/// The checkpoints in the corpus have this many floats and this identity.
constexpr std::uint64_t floats = 12;
const SampleIdentity identity = {{"scene", "abc"}, {"seed", "7"}};

void read_as_checkpoint(std::string_view text) {
    const auto file = fuzz::put("input.checkpoint", text);
    fuzz::read_or_refuse([&] {
        const RenderCheckpoint checkpoint = read_checkpoint(file, identity, floats);
        if (checkpoint.sums.size() + checkpoint.statistics.size() != floats)
            fuzz::fail("a checkpoint of another size than asked for");
        if (checkpoint.passes.empty() || checkpoint.identity != identity)
            fuzz::fail("a checkpoint of another render");
        for (const RenderProgress& pass : checkpoint.passes)
            fuzz::require_finite(pass.seconds, "seconds of a pass");
    });
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    fuzz::read_digested(bytes, size, read_as_checkpoint);
    return 0;
}
