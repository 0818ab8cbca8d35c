#pragma once

#include <cstdlib>
#include <initializer_list>

namespace reradiant {

/// Returns true when a launcher says that it started this process: Open MPI, MPICH and its kin, or
/// any through PMIx. A program that nobody launched need not wait for MPI's start.
inline bool is_launched() {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"})
        if (std::getenv(name) != nullptr)
            return true;
    return false;
}

/// Returns the first of these variables that is set, as a number; `otherwise` when none is.
inline int launcher_number(std::initializer_list<const char*> names, int otherwise) {
    for (const char* name : names)
        if (const char* text = std::getenv(name))
            return std::atoi(text);
    return otherwise;
}

/// These return the number of processes and the rank of this one, as far as launchers say them.
inline int launched_processes() {
    return launcher_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}, 1);
}
inline int launched_rank() {
    return launcher_number({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}, 0);
}

} // namespace reradiant
