#include "host/scene/toml/included_files.h"

#include <algorithm>

#include <fmt/format.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

/// A file by one name, however it is named.
fs::path one_name(const fs::path& file) {
    std::error_code failure;
    fs::path name = fs::weakly_canonical(file, failure);
    return failure ? file : name;
}

std::string way_of(const std::vector<fs::path>& files, const fs::path& back) {
    std::string way;
    for (const fs::path& file : files)
        way += fmt::format("{} includes ", file.filename().string());
    return way + back.filename().string();
}

} // namespace

IncludedFiles::IncludedFiles(const TableReader& root, LoadState& state) {
    readers_.push_back(root);
    open_.push_back(one_name(root.file()));
    include_from(root, state);
}

void IncludedFiles::include_from(const TableReader& reader, LoadState& state) {
    reader.describe("include", "array of file names");
    if (!reader.has("include"))
        return;
    const toml::node& node = reader.required("include");
    const toml::array* names = node.as_array();
    if (names == nullptr || !names->is_homogeneous<std::string>())
        reader.fail("include", fmt::format("include is {}", toml_type_name(node)),
                    "write an array of file names: [\"materials.toml\"]");
    for (const toml::node& name : *names) {
        const SourcePosition at =
            position_of(reader.file(), name, reader.position_of_key("include"));
        const fs::path file = state.resolve_and_digest(*name.value<std::string>(), at);
        const fs::path known = one_name(file);
        if (std::ranges::find(open_, known) != open_.end())
            throw_input_error(at, fmt::format("files include each other: {}", way_of(open_, known)),
                              "leave one of them out");
        if (std::ranges::find(read_, known) != read_.end())
            continue;
        read_.push_back(known);
        open_.push_back(known);
        tables_.push_back(parse_toml(file.string(), read_file(file, at, MAX_TOML_BYTES)));
        const TableReader included(tables_.back(), file.string(), "a file of materials",
                                   {"material", "texture", "include"});
        readers_.push_back(included);
        include_from(included, state);
        open_.pop_back();
    }
}

} // namespace reradiant
