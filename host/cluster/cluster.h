#pragma once

#include "host/base/team.h"

#include <memory>
#include <string>

namespace reradiant {

/// The processes that `mpirun` (or srun) started together with this one; null when it was started
/// by itself or alone, which needs no call of MPI. Input Error when there are others and the
/// program was built without MPI: each would do the same work over the same files. The team leaves
/// MPI when it is destroyed.
std::unique_ptr<Team> join_cluster();

/// Reports a failure of main. The leader's message is printed where all fail alike; then this
/// process and all others of its team end with `code`. Without a team it prints the message and
/// returns.
void fail_in_cluster(int code, const std::string& message);

/// "Open MPI v4.1.4"; "no MPI" when built without.
std::string mpi_version();

} // namespace reradiant
