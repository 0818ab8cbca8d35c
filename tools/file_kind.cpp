#include "tools/file_kind.h"

#include "host/error.h"
#include "host/film/exr_channels.h"
#include "host/regular_file.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/text_format.h"

#include <algorithm>
#include <string>
#include <vector>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

std::ifstream open(const fs::path& file) {
    std::ifstream stream = open_regular_file(file);
    if (!stream)
        throw_input_error({file.string()}, "cannot be opened",
                          "give a file that exists and is readable");
    return stream;
}

/// True when some line begins with the text, blanks aside.
bool has_line(const fs::path& file, const std::string& text) {
    std::ifstream stream = open(file);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t first = line.find_first_not_of(" \t");
        if (first != std::string::npos && line.compare(first, text.size(), text) == 0)
            return true;
    }
    return false;
}

bool is_bispectral(const fs::path& file) {
    const std::vector<std::string> names = exr_channel_names(file);
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.starts_with("T."); });
}

} // namespace

FileKind file_kind(const fs::path& file) {
    open(file);
    const std::string ending = lower_case_ending(file);
    if (ending == ".toml")
        return has_line(file, "[material]") && !has_line(file, "[film]") ? FileKind::Material
                                                                         : FileKind::Scene;
    if (ending == ".exr")
        return is_bispectral(file) ? FileKind::Matrix : FileKind::Image;
    if (ending == ".bfc")
        return FileKind::Matrix;
    const TextFormat format = text_format_of(file);
    if (format == TextFormat::JcampDx || format == TextFormat::Cgats || format == TextFormat::Tm27)
        return FileKind::Spectrum;
    if (ending == ".xml")
        return FileKind::Scene;
    if (ending == ".csv" || ending == ".spd")
        return holds_reradiation(file) ? FileKind::Matrix : FileKind::Spectrum;
    throw_input_error({file.string()}, "has no ending that is known",
                      "endings are .toml, .xml, .csv, .exr, .bfc, .spd");
}

} // namespace reradiant
