#include "tools/outputs.h"

#include "host/error.h"
#include "host/output_file.h"
#include "host/spectral/matrix_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

/// Whatever else a name may end in says nothing about the format.
constexpr std::array known_endings = {".exr",  ".png", ".csv", ".json", ".html", ".svg", ".toml",
                                      ".xml",  ".bfc", ".spd", ".ply",  ".obj",  ".hdr", ".pfm",
                                      ".jpeg", ".jpg", ".tif", ".tiff", ".ocio"};

template <typename List>
bool holds(const List& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

void check_ending(const NamedOutput& output) {
    const std::string ending = lower_case_ending(output.file);
    if (output.endings.empty() || holds(output.endings, ending) ||
        (!output.ending_chooses && !holds(known_endings, ending)))
        return;
    throw_input_error({output.file.string()},
                      fmt::format("what {} writes does not fit into '{}'", output.option, ending),
                      fmt::format("write {}", fmt::join(output.endings, ", ")));
}

/// The same for all names that links lead to one file by.
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
            check_ending(output);
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
    return given.has_filename() ? given : given.parent_path();
}

fs::path checkpoint_beside(const fs::path& output) {
    return output_file(output).is_stream ? fs::path{} : fs::path(output.string() + ".checkpoint");
}

} // namespace reradiant
