#pragma once

#include "host/scene/document/table_reader.h"
#include "host/study/study/study_file.h"

namespace reradiant {

/// Keys of a [[sweep]].
inline const std::vector<std::string> sweep_keys{"key",   "parameter",   "layer", "light",
                                                 "label", "fluorophore", "names", "values"};

/// Fills kind, path, index, label and position of a sweep from its table. `study` holds base and
/// material. Input Error at the key or parameter that does not fit them.
void resolve_target(const TableReader& reader, const Study& study, Sweep& sweep);

/// True when both change the same thing, or one the whole of what the other is a part of.
bool targets_collide(const Sweep& a, const Sweep& b);

} // namespace reradiant
