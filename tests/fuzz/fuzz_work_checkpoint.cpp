#include "host/fit/solve_journal.h"
#include "host/measure/walk_states.h"
#include "host/render/work_checkpoint.h"
#include "host/scene/sha256.h"
#include "tests/fuzz/fuzz_input.h"

// Checkpoints of fits and of measurements by the walk. The digest at the end keeps a fuzzer out of
// all that comes before it, so every input is read as it is and again with its digest made right.

using namespace reradiant;

namespace {

constexpr std::size_t digest_letters = 64;
/// As in the corpus.
const SampleIdentity identity = {{"data", "abc"}, {"seed", "7"}};

void read_as_walks(const nlohmann::json& state) {
    for (const WalkState& walk : walk_states_from(state))
        fuzz::require_all_finite(walk.numbers, "sums of walks");
}

void read_as_steps(const nlohmann::json& state) {
    SolveJournal journal(state);
    const nlohmann::json written = journal.json();
    if (SolveJournal(written).json() != written)
        fuzz::fail("the steps are others once they were written");
}

void read_as_checkpoint(std::string_view text) {
    const auto file = fuzz::put("input.checkpoint", text);
    fuzz::read_or_refuse([&] {
        const nlohmann::json state = read_work_checkpoint(file, identity);
        fuzz::read_or_refuse([&] { read_as_walks(state); });
        fuzz::read_or_refuse([&] { read_as_steps(state); });
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
