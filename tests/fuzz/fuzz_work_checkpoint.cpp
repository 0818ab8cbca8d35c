#include "host/fit/solver/solve_journal.h"
#include "host/measure/walk_states.h"
#include "host/render/checkpoint/work_checkpoint.h"
#include "tests/fuzz/digested_input.h"

// Checkpoints of fits and of measurements by the walk.

using namespace reradiant;

namespace {

/// The checkpoints in the corpus have this identity.
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
    fuzz::read_digested(bytes, size, read_as_checkpoint);
    return 0;
}
