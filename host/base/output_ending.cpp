#include "host/base/output_ending.h"

#include "reradiant/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace reradiant {

namespace {

constexpr std::array format_endings = {
    ".exr",  ".png", ".jpg", ".jpeg", ".tif",  ".tiff", ".hdr",  ".pfm",  ".gif", ".webp",
    ".bmp",  ".tga", ".ppm", ".svg",  ".pdf",  ".html", ".htm",  ".md",   ".csv", ".tsv",
    ".txt",  ".dat", ".xls", ".xlsx", ".ods",  ".json", ".toml", ".yaml", ".yml", ".xml",
    ".spdx", ".spd", ".bfc", ".jdx",  ".ply",  ".obj",  ".ocio", ".npy",  ".npz", ".mat",
    ".h5",   ".zip", ".py",  ".osl",  ".glsl", ".mtlx"};

template <typename List>
bool holds(const List& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

} // namespace

std::string lower_case_ending(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& letter : ending)
        if (letter >= 'A' && letter <= 'Z')
            letter = static_cast<char>(letter - 'A' + 'a');
    return ending;
}

bool is_format_ending(const std::string& lower_case_ending) {
    return holds(format_endings, lower_case_ending);
}

void check_output_ending(const std::filesystem::path& file, const std::vector<std::string>& endings,
                         const std::string& writer, const std::string& remedy) {
    if (is_format_ending(lower_case_ending(file)))
        require_output_ending(file, endings, writer, remedy);
}

void require_output_ending(const std::filesystem::path& file,
                           const std::vector<std::string>& endings, const std::string& writer,
                           const std::string& remedy) {
    const std::string ending = lower_case_ending(file);
    if (holds(endings, ending))
        return;
    const std::string right = fmt::format("name a {} here", fmt::join(endings, " or "));
    throw_input_error(
        {file.string()},
        fmt::format("{} writes {}, and the name {}", writer, fmt::join(endings, " or "),
                    ending.empty() ? "has no ending" : fmt::format("ends in {}", ending)),
        remedy.empty() ? right : fmt::format("{}, and {}", remedy, right));
}

} // namespace reradiant
