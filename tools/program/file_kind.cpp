#include "tools/program/file_kind.h"

#include "host/base/output_ending.h"
#include "host/base/regular_file.h"
#include "host/film/exr_channels.h"
#include "host/scene/toml/scene_table.h"
#include "host/spectral/text/csv_lines.h"
#include "host/spectral/text/text_format.h"
#include "host/spectral/text/text_reader.h"
#include "reradiant/error.h"
#include "reradiant/spectral_files.h"

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

bool is_bispectral(const fs::path& file) {
    const std::vector<std::string> names = exr_channel_names(file);
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.starts_with("T."); });
}

FileKind kind_of_toml(const fs::path& file) {
    const toml::table table = read_scene_table(file);
    if (table.contains("study") || table.contains("sweep"))
        return FileKind::Study;
    if (table.contains("figure") || table.contains("image"))
        return FileKind::Figure;
    if (table.contains("fluorophore") || table.contains("emission_nm"))
        return FileKind::Recipe;
    const toml::table* const material = table["material"].as_table();
    if (material == nullptr || table.contains("film"))
        return FileKind::Scene;
    const bool is_whole = !material->contains("layer") || material->contains("substrate");
    return is_whole ? FileKind::Material : FileKind::Layers;
}

FileKind kind_of_table(const fs::path& file) {
    TextReader reader(file);
    for (std::string_view line; reader.next_line(line);) {
        if (!is_line_of_cells(line))
            continue;
        const std::vector<TextToken> cells = reader.split_cells(line);
        const auto is = [&](std::size_t k, std::string_view name) {
            return k < cells.size() && lower_case(cells[k].text) == name;
        };
        if (is(0, "theta_i_deg"))
            return FileKind::Measurement;
        if (is(0, "part") && is(1, "nm"))
            return FileKind::Covariance;
        if (is(0, "name") && is(1, "illuminant"))
            return FileKind::Polygons;
        if (cells.size() == 3 && is(1, "n") && is(2, "k"))
            return FileKind::ComplexIndex;
        break;
    }
    return holds_reradiation(file) ? FileKind::Matrix : FileKind::Spectrum;
}

} // namespace

FileKind file_kind(const fs::path& file) {
    open(file);
    const std::string ending = lower_case_ending(file);
    if (ending == ".toml")
        return kind_of_toml(file);
    if (ending == ".exr")
        return is_bispectral(file) ? FileKind::Matrix : FileKind::Image;
    if (ending == ".png")
        return FileKind::Image;
    if (ending == ".bfc")
        return FileKind::Matrix;
    if (ending == ".ply" || ending == ".obj")
        return FileKind::Mesh;
    if (ending == ".ocio")
        return FileKind::DisplayConfig;
    const TextFormat format = text_format_of(file);
    if (format == TextFormat::JcampDx || format == TextFormat::Cgats || format == TextFormat::Tm27)
        return FileKind::Spectrum;
    if (ending == ".xml")
        return FileKind::Scene;
    return format == TextFormat::Table ? kind_of_table(file) : FileKind::Spectrum;
}

} // namespace reradiant
