#pragma once

#include "tools/program/command.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A file that a command line names to be written.
struct NamedOutput {
    std::string option;         ///< "--png", for messages
    std::filesystem::path file; ///< empty: not asked for
    /// Endings of what is written, with the dot, the first one usual. Another ending that is known
    /// is refused, naming the option that writes it: an EXR called .png is none.
    std::vector<std::string> endings = {};
    bool ending_chooses = false; ///< which of them is written: one must be there
    /// The advice for another format, which no other option of the command writes.
    std::string elsewhere = {};
};

/// Refuses, before work goes into it, whatever a command is told to write and could not: see
/// check_output_file; a wrong ending; one file for two outputs; and an output that is one of the
/// files `read`, which it would destroy. --json is one of the outputs. What lies in `folder`, which
/// the command makes itself, need not have that yet.
void check_outputs(const CommonOptions& common, std::vector<NamedOutput> outputs,
                   const std::vector<std::filesystem::path>& read = {},
                   const std::filesystem::path& folder = {});

/// Returns a folder to write results into, as it was given but without a slash at its end. Refuses
/// what check_output_folder refuses, and a name that claims to be a file's.
std::filesystem::path output_directory(const std::filesystem::path& given);

/// Returns FILE.checkpoint beside an output; nothing where that is a device or a pipe.
std::filesystem::path checkpoint_beside(const std::filesystem::path& output);

} // namespace reradiant
