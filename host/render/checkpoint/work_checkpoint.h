#pragma once

#include "reradiant/merge.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace reradiant {

/// Writes a checkpoint of work whose state is numbers, atomically and synced
/// (host/base/atomic_file.h): a line that names the format, identity and state as CBOR (RFC 8949),
/// and a SHA-256 of it all. Run-time Error when the disk does not take it.
void write_work_checkpoint(const std::filesystem::path& file, const SampleIdentity& identity,
                           const nlohmann::json& state);

/// The state that a checkpoint of the work `identity` holds. Input Error for a file that is
/// damaged, cut off or larger than 1 GiB, and for one of other work, naming what differs. What
/// the state holds is for its owner to check.
nlohmann::json read_work_checkpoint(const std::filesystem::path& file,
                                    const SampleIdentity& identity);

} // namespace reradiant
