#include "host/base/output_ending.h"
#include "host/film/exr_channels.h"
#include "host/report/json_file.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/evidence/scatter_warnings.h"
#include "host/spectral/spectrum/spectrum_formats.h"
#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "reradiant/spectral_image.h"
#include "tools/commands/describe_material.h"
#include "tools/commands/print_tree.h"
#include "tools/program/command.h"
#include "tools/program/file_kind.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json describe_grid(const WavelengthGrid& grid) {
    return {{"from_nm", grid.from_nm},
            {"to_nm", grid.to_nm()},
            {"step_nm", grid.step_nm},
            {"count", grid.count}};
}

Json describe_image(const fs::path& file) {
    const SpectralImage image = read_spectral_exr(file);
    double sum = 0.0;
    std::size_t non_finite = 0;
    for (const float value : image.values)
        std::isfinite(value) ? void(sum += value) : void(++non_finite);
    Json result = {{"kind", "spectral image"},
                   {"width", image.width},
                   {"height", image.height},
                   {"bands", describe_grid(image.bands)},
                   {"mean_radiance", sum / static_cast<double>(image.values.size())},
                   {"non_finite", non_finite}};
    if (!image.sample_count.empty()) {
        const auto [low, high] =
            std::minmax_element(image.sample_count.begin(), image.sample_count.end());
        result["samples"] = {{"lowest", *low}, {"highest", *high}};
    }
    result["variance"] = image.variance_y.empty()       ? "none"
                         : image.variance_bands.empty() ? "of Y"
                                                        : "of Y and of every band";
    for (const LightLayer& layer : light_layers_of(file))
        result["light_layers"].push_back(
            {{"name", layer.name()}, {"from_nm", layer.from_nm}, {"to_nm", layer.to_nm}});
    result["attributes"] = image.attributes;
    return result;
}

Json describe_exr(const fs::path& file) {
    const std::vector<std::string> channels = exr_channel_names(file);
    const auto any = [&](const char* prefix) {
        return std::any_of(channels.begin(), channels.end(),
                           [&](const std::string& name) { return name.starts_with(prefix); });
    };
    if (any("S0."))
        return describe_image(file);
    return {{"kind", "image without a spectrum"}, {"channels", channels}};
}

Json describe_matrix(const fs::path& file) {
    const ReradiationMatrix matrix = read_reradiation(file);
    warn_of_matrix(file.string(), matrix);
    const ColumnBalance balance = column_balance(matrix);
    const auto highest = [](const std::vector<double>& sums) {
        return sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end());
    };
    Json result = {{"kind", "re-radiation matrix"},
                   {"claims", matrix.kind == MatrixKind::Model ? "model" : "measured"},
                   {"quantity", "per-band"},
                   {"geometry", matrix.geometry},
                   {"anti_stokes_allowed", matrix.anti_stokes_allowed},
                   {"fluorescent", matrix.is_fluorescent()},
                   {"emission", describe_grid(matrix.emission)},
                   {"excitation", describe_grid(matrix.excitation)},
                   {"largest_radiant_column_sum", highest(balance.radiant)},
                   {"largest_photon_column_sum", highest(balance.photons)}};
    if (const std::vector<std::string> scatter = scatter_warnings(matrix); !scatter.empty())
        result["scatter"] = scatter;
    return result;
}

Json describe_complex_index(const fs::path& file) {
    const NumberTable table = read_number_table(file, 3);
    const auto range = [&](std::size_t column) {
        const auto [low, high] =
            std::minmax_element(table.columns[column].begin(), table.columns[column].end());
        return Json{{"lowest", *low}, {"highest", *high}};
    };
    return {{"kind", "complex index of refraction"},
            {"from_nm", table.columns[0].front()},
            {"to_nm", table.columns[0].back()},
            {"n", range(1)},
            {"k", range(2)}};
}

Json describe_spectrum(const fs::path& file) {
    const NumberTable table = read_spectrum_table(file);
    const auto [low, high] = std::minmax_element(table.columns[1].begin(), table.columns[1].end());
    const double from = table.columns[0].front(), to = table.columns[0].back();
    return {{"kind", "spectrum"},
            {"from_nm", from},
            {"to_nm", to},
            {"lowest", *low},
            {"highest", *high}};
}

Json describe_scene(const fs::path& file) {
    const Scene scene = load_scene(file);
    Json result = {{"kind", "scene"},
                   {"width", scene.film.width},
                   {"height", scene.film.height},
                   {"lights", scene.lights.size()},
                   {"shapes", scene.shapes.size()},
                   {"max_depth", scene.integrator.max_depth},
                   {"hash", scene.hash},
                   {"textures", scene.textures.size()},
                   {"materials", describe_surfaces(scene)}};
    if (scene.film.bands)
        result["bands"] = describe_grid(*scene.film.bands);
    return result;
}

Json describe(const fs::path& file) {
    switch (file_kind(file)) {
    case FileKind::Scene:
        return describe_scene(file);
    case FileKind::Material: {
        Json result = {{"kind", "material"}};
        result.update(describe_material(load_material(file)));
        return result;
    }
    case FileKind::Matrix:
        return describe_matrix(file);
    case FileKind::Spectrum:
        return describe_spectrum(file);
    case FileKind::ComplexIndex:
        return describe_complex_index(file);
    case FileKind::Image:
        if (lower_case_ending(file) == ".exr")
            return describe_exr(file);
        break;
    case FileKind::Layers:
    case FileKind::Recipe:
    case FileKind::Study:
    case FileKind::Figure:
    case FileKind::Covariance:
    case FileKind::Measurement:
    case FileKind::Polygons:
    case FileKind::Mesh:
    case FileKind::DisplayConfig:
        break;
    }
    throw_input_error({file.string()}, "is no file that is described here",
                      "`reradiant validate` checks it and says what it holds");
}

} // namespace

void add_info_command(Program& program, CommandContext& context) {
    auto file = std::make_shared<fs::path>();
    Command command = program.add_command(
        "info", "Says what a file holds: image, re-radiation matrix, spectrum, scene, material");
    command
        .option("FILE", *file,
                "scene (TOML, or XML of Mitsuba 3), material (TOML), spectral image (EXR), "
                "re-radiation matrix (CSV, BFC or EXR), spectrum (CSV, SPD, JCAMP-DX, CGATS or IES "
                "TM-27), or index of refraction of a metal (CSV of nm,n,k)")
        .required();
    command.footer("Example: reradiant info out.exr");
    command.callback([file, &context] {
        check_outputs(context.common, {}, {*file});
        const Json description = describe(*file);
        write_json(context.common.json, description);
        print_tree(description);
    });
}

} // namespace reradiant
