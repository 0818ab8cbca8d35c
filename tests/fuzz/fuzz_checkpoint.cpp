#include "host/render/checkpoint.h"
#include "host/scene/sha256.h"
#include "tests/fuzz/fuzz_input.h"

// Checkpoints of a render. The digest at the end keeps a fuzzer out of all that comes after it, so
// every input is read as it is and again with its digest made right.

using namespace reradiant;

namespace {

constexpr std::size_t digest_letters = 64;
/// As in the corpus.
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
    const std::string_view text = fuzz::text_of(bytes, size);
    read_as_checkpoint(text);
    if (size <= digest_letters)
        return 0;
    const std::string body(text.substr(0, size - digest_letters));
    Sha256 digest;
    digest.update(body);
    read_as_checkpoint(body + digest.hex());
    return 0;
}
