#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace reradiant {

/// Writes a machine-readable result (`--json`), indented, atomically; keys keep their order, NaN
/// and infinity become null. An empty file name writes nothing.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value);

} // namespace reradiant
