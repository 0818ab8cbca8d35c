#pragma once

#include "host/base/team.h"

namespace reradiant {

/// Threads for a member that may have all: the cores that it is bound to, and no more than its
/// share where members of one machine are not bound.
int share_of_cores(const Team& team);

} // namespace reradiant
