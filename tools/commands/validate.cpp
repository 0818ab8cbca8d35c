#include "host/base/logging.h"
#include "host/base/output_ending.h"
#include "host/film/display/display_picture.h"
#include "host/film/exr_channels.h"
#include "host/geometry/geometry.h"
#include "host/report/json_file.h"
#include "host/scene/images/image_io.h"
#include "host/scene/meshes/mesh_io.h"
#include "host/scene/toml/stack_file.h"
#include "host/spectral/colour/colour_polygons.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/spectrum/spectrum_formats.h"
#include "host/study/study/study_file.h"
#include "reradiant/bispectral_data.h"
#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "reradiant/spectral_image.h"
#include "reradiant/synth.h"
#include "tools/commands/describe_material.h"
#include "tools/commands/figure/figure_request.h"
#include "tools/commands/print_tree.h"
#include "tools/commands/reference.h"
#include "tools/program/command.h"
#include "tools/program/file_kind.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string range_text(double from_nm, double to_nm) {
    return fmt::format("{} to {} nm", from_nm, to_nm);
}

std::string grid_text(const WavelengthGrid& grid) {
    return fmt::format("{} by {} nm", range_text(grid.from_nm, grid.to_nm()), grid.step_nm);
}

/// A measurement with gaps, which only a fit takes.
Json validate_gaps(const fs::path& file, const ReradiationMatrix& matrix) {
    warn_of_matrix(file.string(), matrix);
    const auto gaps = (matrix.values.array() != matrix.values.array()).count();
    return {{"kind", "re-radiation matrix"},
            {"claims", "measured"},
            {"emission", grid_text(matrix.emission)},
            {"excitation", grid_text(matrix.excitation)},
            {"gaps", gaps},
            {"use", "`fit` takes it; scenes and colours need every entry"},
            {"warnings", matrix_warnings(matrix)}};
}

/// Column sums, and what rendering would change in the matrix (warnings go to the log).
Json validate_matrix(const fs::path& file) {
    ReradiationMatrix matrix = read_reradiation(file, Gaps::BecomeNan);
    if (!matrix.values.allFinite()) {
        if (matrix.kind == MatrixKind::Measured)
            return validate_gaps(file, matrix);
        read_reradiation(file); // says where
    }
    const ColumnBalance balance = column_balance(matrix);
    const auto largest = [](const std::vector<double>& sums) {
        return *std::max_element(sums.begin(), sums.end());
    };
    Json result = {{"kind", "re-radiation matrix"},
                   {"claims", matrix.kind == MatrixKind::Model ? "model" : "measured"},
                   {"emission", grid_text(matrix.emission)},
                   {"excitation", grid_text(matrix.excitation)},
                   {"fluorescent", matrix.is_fluorescent()},
                   {"largest_energy_sum", largest(balance.radiant)},
                   {"largest_photon_sum", largest(balance.photons)}};
    std::vector<std::string> warnings;
    try {
        const std::string repairs = repair_for_rendering(matrix, warnings).text();
        if (!repairs.empty())
            warnings.insert(warnings.begin(), repairs);
    } catch (const std::invalid_argument& error) {
        throw_input_error({file.string()}, error.what());
    }
    for (const auto& warning : warnings)
        logging::warn("{}: {}", file.string(), warning);
    result["warnings"] = warnings;
    return result;
}

Json validate_spectrum(const fs::path& file) {
    const NumberTable table = read_spectrum_table(file);
    const auto [low, high] = std::minmax_element(table.columns[1].begin(), table.columns[1].end());
    const double from = table.columns[0].front(), to = table.columns[0].back();
    return {{"kind", "spectrum"},
            {"range", range_text(from, to)},
            {"lowest", *low},
            {"highest", *high}};
}

Json validate_material(const fs::path& file) {
    Json result = {{"kind", "material"}};
    result.update(describe_material(load_material(file)));
    return result;
}

/// Builds the geometry too, which checks every primitive.
Json validate_scene(const fs::path& file) {
    const Scene scene = load_scene(file);
    const Geometry geometry(scene);
    Json result = {{"kind", "scene"},
                   {"film", fmt::format("{} x {}", scene.film.width, scene.film.height)},
                   {"lights", scene.lights.size()},
                   {"shapes", scene.shapes.size()},
                   {"triangles", geometry.triangle_count()},
                   {"hash", scene.hash}};
    if (scene.film.bands)
        result["bands"] = grid_text(*scene.film.bands);
    result["textures"] = scene.textures.size();
    result["materials"] = describe_surfaces(scene);
    return result;
}

Json validate_mesh(const fs::path& file) {
    const MeshShape mesh = read_mesh(file);
    return {{"kind", "mesh"},
            {"vertices", mesh.positions.size() / 3},
            {"triangles", mesh.indices.size() / 3},
            {"shading_normals", !mesh.normals.empty()},
            {"texture_coordinates", !mesh.texture_coordinates.empty()}};
}

Json validate_recipe(const fs::path& file) {
    const SynthRecipe recipe = read_synth_recipe(file);
    return {{"kind", "recipe of synth"},
            {"emission", grid_text(recipe.emission)},
            {"excitation", grid_text(recipe.excitation)},
            {"fluorophores", recipe.fluorophores.size()},
            {"layers", recipe.stack.layers.size()},
            {"geometries", recipe.geometries.size()}};
}

Json validate_study(const fs::path& file) {
    const Study study = load_study(file);
    return {{"kind", "study"},
            {"title", study.title},
            {"sweeps", study.sweeps.size()},
            {"cells", study.cell_count()}};
}

Json validate_figure(const fs::path& file) {
    const FigureRequest figure = read_figure_request(file);
    std::size_t marks = 0;
    for (const ImageRequest& image : figure.images)
        marks += image.marks.size();
    return {{"kind", "figure"},
            {"images", figure.images.size()},
            {"plots", figure.plots.size()},
            {"swatches", figure.swatches.size()},
            {"marks", marks}};
}

Json validate_measurement(const fs::path& file) {
    const BispectralData data = read_bispectral_data(file);
    return {{"kind", "measurement"},
            {"emission", grid_text(data.emission)},
            {"excitation", grid_text(data.excitation)},
            {"geometries", data.blocks.size()},
            {"entries", data.measured_count()}};
}

Json validate_complex_index(const fs::path& file) {
    const NumberTable table = read_number_table(file, 3);
    return {{"kind", "complex index of refraction"},
            {"range", range_text(table.columns[0].front(), table.columns[0].back())}};
}

/// A spectral EXR, which is compared and merged, or the colours of a texture or an environment.
Json validate_image(const fs::path& file) {
    const bool is_exr = lower_case_ending(file) == ".exr";
    const std::vector<std::string> channels =
        is_exr ? exr_channel_names(file) : std::vector<std::string>{};
    if (std::any_of(channels.begin(), channels.end(),
                    [](const std::string& name) { return name.starts_with("S0."); })) {
        const SpectralImage image = read_spectral_exr(file);
        return {{"kind", "spectral image"},
                {"size", fmt::format("{} x {}", image.width, image.height)},
                {"bands", grid_text(image.bands)}};
    }
    const Image image = is_exr ? read_exr_image(file, ImageEncoding::Srgb)
                               : read_png_image(file, ImageEncoding::Srgb);
    return {{"kind", "image"}, {"size", fmt::format("{} x {}", image.width, image.height)}};
}

Json validate_covariance(const fs::path& file) {
    const MatrixCovariance covariance = read_covariance_csv(file);
    return {{"kind", "covariance of a re-radiation matrix"},
            {"emission", grid_text(covariance.emission)},
            {"excitation", grid_text(covariance.excitation)},
            {"directions", covariance.directions.cols()},
            {"entries whose error is not known", covariance.independent.array().isNaN().count()}};
}

Json validate(const fs::path& file) {
    switch (file_kind(file)) {
    case FileKind::Scene:
        return validate_scene(file);
    case FileKind::Material:
        return validate_material(file);
    case FileKind::Layers:
        return {{"kind", "layers"}, {"layers", load_stack(file).layers.size()}};
    case FileKind::Recipe:
        return validate_recipe(file);
    case FileKind::Study:
        return validate_study(file);
    case FileKind::Figure:
        return validate_figure(file);
    case FileKind::Matrix:
        return validate_matrix(file);
    case FileKind::Covariance:
        return validate_covariance(file);
    case FileKind::Measurement:
        return validate_measurement(file);
    case FileKind::Spectrum:
        return validate_spectrum(file);
    case FileKind::ComplexIndex:
        return validate_complex_index(file);
    case FileKind::Polygons:
        return {{"kind", "polygons of colour"}, {"polygons", read_colour_polygons(file).size()}};
    case FileKind::Mesh:
        return validate_mesh(file);
    case FileKind::Image:
        return validate_image(file);
    case FileKind::DisplayConfig:
        check_display({.ocio_config = file, .display = {}, .view = {}});
        return {{"kind", "config of OpenColorIO"}};
    }
    throw_input_error({file.string()}, "is of an unknown kind");
}

} // namespace

void add_validate_command(Program& program, CommandContext& context) {
    struct Options {
        fs::path file;
        bool reference = false;
    };
    auto options = std::make_shared<Options>();
    Command command = program.add_command(
        "validate", "Checks any file that another command takes, and says what it holds");
    Command what = command.one_of_group("what");
    what.option(
        "FILE", options->file,
        "scene, material, layers, recipe, study or figure (TOML, XML), matrix (CSV, BFC, EXR), "
        "covariance, measurement, spectrum (also JCAMP-DX, CGATS, IES TM-27), polygons, mesh (PLY, "
        "OBJ), image (EXR, PNG) or OpenColorIO config (.ocio)");
    what.flag("--reference", options->reference,
              "print every key of scene and material files, as Markdown");
    command.footer("Examples:\n"
                   "  reradiant validate scene.toml\n"
                   "  reradiant validate --reference > reference.md");
    command.callback([options, &context] {
        if (options->reference) {
            fmt::print("{}", format_reference());
            return;
        }
        check_outputs(context.common, {}, {options->file});
        const Json result = validate(options->file);
        write_json(context.common.json, result);
        Json shown = result;
        shown.erase("warnings"); // the log has them
        print_tree(shown);
        fmt::print("valid\n");
    });
}

} // namespace reradiant
