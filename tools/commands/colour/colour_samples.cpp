#include "tools/commands/colour/colour_samples.h"

#include "host/base/logging.h"
#include "host/measure/geometry_matrix.h"
#include "host/measure/measured_sample.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "tools/program/file_kind.h"
#include "tools/program/parse_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

constexpr const char* samples_are =
    "a colour is that of a re-radiation matrix (.csv, .bfc, .exr), a material (.toml), or the "
    "directions that `measure` wrote (.csv)";

/// What a file is called that is no sample; null for what its own reader speaks about.
const char* other_kind(FileKind kind) {
    switch (kind) {
    case FileKind::Study:
        return "a study";
    case FileKind::Figure:
        return "a figure";
    case FileKind::Recipe:
        return "a recipe of `synth`";
    case FileKind::Layers:
        return "a stack without a substrate";
    case FileKind::Covariance:
        return "the covariance of a matrix, which --covariance takes beside it";
    case FileKind::ComplexIndex:
        return "the complex index of a metal";
    case FileKind::Polygons:
        return "a file of polygons";
    case FileKind::Mesh:
        return "a mesh";
    case FileKind::Image:
        return "an image";
    case FileKind::DisplayConfig:
        return "a configuration of OpenColorIO";
    default:
        return nullptr;
    }
}

bool takes_geometry(FileKind kind) {
    return kind == FileKind::Measurement || kind == FileKind::Material || kind == FileKind::Scene;
}

ViewingGeometry asked_geometry(const ColourOptions& options) {
    try {
        return options.geometry.empty() ? ViewingGeometry{} : viewing_geometry(options.geometry);
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--geometry: {}", error.what()));
    }
}

ReradiationMatrix declared_matrix(const fs::path& file, const std::string& asked) {
    ReradiationMatrix matrix = read_reradiation(file);
    warn_of_matrix(file.string(), matrix);
    if (!asked.empty() && !matrix.geometry.empty() && matrix.geometry != asked)
        logging::warn("{}: was measured at {}, which --geometry {} does not change", file.string(),
                      matrix.geometry, asked);
    return matrix;
}

/// A lamp behind a blank is taken as a sample.
void require_file(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored) && !file.has_extension())
        throw_input_error({file.string()}, "cannot be opened",
                          "give a file; lamps and observers stand between commas, as in "
                          "--illuminant D65,A");
}

/// True for a table that is read as a spectrum and says nothing of re-radiation.
bool is_spectrum(const fs::path& file) {
    try {
        read_spectrum(file);
        return true;
    } catch (const Error&) {
        return false;
    }
}

ReradiationMatrix read_matrix(const fs::path& file, const ColourOptions& options) {
    require_file(file);
    const FileKind kind = file_kind(file);
    if (kind == FileKind::Spectrum && is_spectrum(file))
        throw_input_error({file.string()}, "this is a spectrum, not a sample",
                          "write a material (.toml) with a substrate of this reflectance; a lamp "
                          "is given by --lamp");
    if (const char* const name = other_kind(kind))
        throw_input_error({file.string()}, fmt::format("this is {}, not a sample", name),
                          samples_are);
    if (!takes_geometry(kind))
        return declared_matrix(file, options.geometry);
    const ViewingGeometry geometry = asked_geometry(options);
    return kind == FileKind::Measurement ? MeasuredSample(file).seen_in(geometry)
                                         : geometry_matrix_of(file, load_material(file), geometry);
}

/// A geometry that changes nothing is a mistake.
void require_use_of_geometry(const ColourOptions& options, std::vector<fs::path> files) {
    asked_geometry(options);
    if (!options.against.empty())
        files.push_back(options.against);
    if (options.geometry.empty() || std::any_of(files.begin(), files.end(), [](const fs::path& f) {
            require_file(f);
            return takes_geometry(file_kind(f));
        }))
        return;
    throw_input_error({files.front().string()},
                      "the geometry of a matrix is that of the instrument that measured it",
                      "--geometry is for materials (.toml, --preset) and for files of `measure`");
}

void shorten_names(std::vector<ColourSample>& samples) {
    std::map<std::string, int> uses;
    for (const ColourSample& sample : samples)
        ++uses[fs::path(sample.name).filename().string()];
    for (ColourSample& sample : samples)
        if (std::string name = fs::path(sample.name).filename().string(); uses[name] == 1)
            sample.short_name = std::move(name);
}

} // namespace

std::vector<fs::path> sample_files(const ColourOptions& options) {
    std::vector<fs::path> files = options.samples;
    for (const std::string& preset : options.presets)
        files.push_back(preset_file(preset));
    if (files.empty())
        throw_input_error({},
                          "colour needs a MATRIX, a MATERIAL.toml, a file of `measure` or a "
                          "--preset",
                          "give one of them, or several");
    return files;
}

std::vector<ColourSample> read_samples(const ColourOptions& options) {
    const std::vector<fs::path> files = sample_files(options);
    require_use_of_geometry(options, files);
    std::set<std::string> names;
    std::vector<ColourSample> samples;
    for (std::size_t k = 0; k < files.size(); ++k) {
        const bool is_preset = k >= options.samples.size();
        std::string name =
            is_preset ? options.presets[k - options.samples.size()] : options.samples[k].string();
        if (!names.insert(name).second)
            throw_input_error({name}, "the sample is given twice", "name every sample once");
        samples.push_back({name, name, files[k], read_matrix(files[k], options)});
    }
    shorten_names(samples);
    return samples;
}

ColourSample read_reference(const ColourOptions& options) {
    return {options.against.string(), options.against.filename().string(), options.against,
            read_matrix(options.against, options)};
}

} // namespace reradiant
