#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// Ending of a file name in small letters, with its dot.
std::string lower_case_ending(const std::filesystem::path& file);

/// Returns whether a name claims to be of a format by its ending: true for .exr, .png, .csv and
/// many more. Whatever else a name ends in (`part.001`) says nothing.
bool is_format_ending(const std::string& lower_case_ending);

/// Refuses, by an input Error at the name, a name that claims to be of another format than the
/// `endings` of what `writer` (an option or a function) writes, the usual one first. `remedy` says
/// who writes what was asked for; empty where nobody does.
void check_output_ending(const std::filesystem::path& file, const std::vector<std::string>& endings,
                         const std::string& writer, const std::string& remedy = {});

/// Refuses, as check_output_ending does, every name that has none of the `endings`, also one that
/// claims no format: for writers that go by the ending.
void require_output_ending(const std::filesystem::path& file,
                           const std::vector<std::string>& endings, const std::string& writer,
                           const std::string& remedy = {});

} // namespace reradiant
