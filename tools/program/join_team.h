#pragma once

#include "host/base/team.h"
#include "tools/program/command.h"

#include <memory>

namespace reradiant {

/// The team that mpirun put this process into, or null. Members other than the leader say nothing
/// and write no JSON from here on; unless --threads says otherwise, those of one machine share its
/// cores.
std::unique_ptr<Team> join_team(CommonOptions& common);

/// Members of `team` on this machine: what its memory is divided by.
int members_on_host(const std::unique_ptr<Team>& team);

} // namespace reradiant
