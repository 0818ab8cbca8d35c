#pragma once

#include "host/scene/document/table_reader.h"
#include "host/study/study/study_file.h"

namespace reradiant {

/// A [[sweep]] table of a study whose base is read. Input Error with line and column for one
/// without values, with a value twice, or of something that the base does not have.
Sweep read_sweep(const toml::table& table, const std::string& file, const Study& study);

/// Refuses sweeps that cannot stand together: none, two of one thing, of what [measure] fixes, too
/// many combinations, and one of which no value makes a valid scene.
void check_sweeps(const Study& study);

/// The texts of an array that must hold one at least.
std::vector<std::string> texts_at(const TableReader& reader, const char* key);

} // namespace reradiant
