#include "host/cluster/cluster.h"
#include "host/cluster/launcher.h"
#include "reradiant/error.h"

#include <fmt/format.h>

namespace reradiant {

std::unique_ptr<Team> join_cluster() {
    if (is_launched() && launched_processes() > 1)
        throw_input_error({},
                          fmt::format("{} processes were started together, but this program was "
                                      "built without MPI",
                                      launched_processes()),
                          "build it where MPI is installed, or render parts by --sample-range and "
                          "`merge` them");
    return nullptr;
}

void fail_in_cluster(int, const std::string& message) {
    fmt::print(stderr, "{}\n", message);
}

std::string mpi_version() {
    return "no MPI";
}

} // namespace reradiant
