#include "tools/program/outputs.h"

#include "host/base/output_ending.h"
#include "host/base/output_file.h"
#include "reradiant/error.h"

#include <fmt/core.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

/// Returns the advice on what writes a file with this ending: another option of the command, or
/// another command.
std::string who_writes(const std::string& ending, const NamedOutput& asked,
                       const std::vector<NamedOutput>& outputs) {
    for (const NamedOutput& output : outputs)
        for (const std::string& own : output.endings)
            if (own == ending && output.option != asked.option)
                return fmt::format("use {} {} for that", output.option, asked.file.string());
    return asked.elsewhere;
}

void check_ending(const NamedOutput& output, const std::vector<NamedOutput>& outputs) {
    if (output.endings.empty())
        return;
    const std::string remedy = who_writes(lower_case_ending(output.file), output, outputs);
    output.ending_chooses
        ? require_output_ending(output.file, output.endings, output.option, remedy)
        : check_output_ending(output.file, output.endings, output.option, remedy);
}

/// Returns one and the same name for all names that lead to one file by links.
fs::path one_name(const fs::path& file) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(file), ignored);
}

void check_not_read(const NamedOutput& output, const fs::path& file,
                    const std::vector<fs::path>& read) {
    for (const fs::path& input : read)
        if (!input.empty() && one_name(input) == file)
            throw_input_error({output.file.string()},
                              fmt::format("{} would write over what is read", output.option),
                              "write to another name");
}

bool lies_in(const fs::path& file, const fs::path& folder) {
    return !folder.empty() && one_name(file).parent_path() == one_name(folder);
}

} // namespace

void check_outputs(const CommonOptions& common, std::vector<NamedOutput> outputs,
                   const std::vector<fs::path>& read, const fs::path& folder) {
    outputs.push_back({"--json", common.json, {".json"}});
    std::vector<std::pair<fs::path, std::string>> met;
    for (const NamedOutput& output : outputs) {
        if (output.file.empty())
            continue;
        const OutputFile place = output_file(output.file);
        if (!place.is_stream || output.ending_chooses)
            check_ending(output, outputs);
        if (place.is_stream) {
            check_output_file(output.file);
            continue;
        }
        if (!lies_in(place.file, folder))
            check_output_file(output.file);
        const fs::path file = one_name(place.file);
        check_not_read(output, file, read);
        for (const auto& [other, option] : met)
            if (other == file)
                throw_input_error(
                    {output.file.string()},
                    fmt::format("{} and {} name the same file", option, output.option),
                    "give each its own");
        met.emplace_back(file, output.option);
    }
}

fs::path output_directory(const fs::path& given) {
    check_output_folder(given);
    std::error_code ignored;
    const std::string ending = lower_case_ending(given);
    if (is_format_ending(ending) && !fs::is_directory(given, ignored))
        throw_input_error({given.string()},
                          fmt::format("-o names a folder here, and the name ends in {}", ending),
                          "name the folder that pages, tables and pictures go into");
    return given.has_filename() ? given : given.parent_path();
}

fs::path checkpoint_beside(const fs::path& output) {
    return output_file(output).is_stream ? fs::path{} : fs::path(output.string() + ".checkpoint");
}

} // namespace reradiant
