#include "tools/program/join_team.h"

#include "host/cluster/cluster.h"
#include "host/cluster/core_share.h"

#include <spdlog/spdlog.h>

namespace reradiant {

std::unique_ptr<Team> join_team(CommonOptions& common) {
    std::unique_ptr<Team> team = join_cluster();
    if (!team)
        return nullptr;
    if (common.threads == 0)
        common.threads = share_of_cores(*team);
    if (!team->leads()) {
        common.quiet = true;
        common.json.clear();
        spdlog::set_level(spdlog::level::err);
    }
    return team;
}

int members_on_host(const std::unique_ptr<Team>& team) {
    return team ? team->size_on_host() : 1;
}

} // namespace reradiant
