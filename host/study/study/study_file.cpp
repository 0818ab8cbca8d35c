#include "host/study/study/study_file.h"

#include "host/base/quiet_log.h"
#include "host/scene/document/load_state.h"
#include "host/scene/model/matrix_grids.h"
#include "host/scene/toml/scene_table.h"
#include "host/study/study/sample_scene.h"
#include "host/study/study/sweep_apply.h"
#include "host/study/study/sweep_reader.h"
#include "host/study/study/toml_path.h"
#include "reradiant/colour.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr int most_film_size = 4096;
constexpr int default_film_size = 96;
const std::vector<std::string> measure_keys{"theta_i_deg", "theta_o_deg", "phi_deg",
                                            "illuminants", "model",       "samples"};

/// Reads one STUDY.toml.
class StudyReader {
public:
    StudyReader(const toml::table& table, const fs::path& file)
        : root_(table, file.string(), "a study", {"study", "render", "measure", "sweep"}),
          head_(root_.table("study", {"title", "scene", "material", "preset"})) {
        study_.file = file;
    }

    Study study() {
        study_.title = head_.text_or("title", study_.file.stem().string());
        if (root_.has("render"))
            read_rendering();
        if (root_.has("measure"))
            read_measuring();
        read_base();
        if (!study_.rendering && !study_.measuring)
            study_.rendering.emplace();
        for (const toml::table* table : root_.tables("sweep"))
            study_.sweeps.push_back(read_sweep(*table, root_.file(), study_));
        check_sweeps(study_);
        return std::move(study_);
    }

private:
    void read_rendering() {
        const TableReader reader = root_.table(
            "render", {"width", "height", "spp", "model", "wavelengths", "exposure_ev"});
        StudyRendering rendering;
        width_ = reader.integer_or("width", 0, 1, most_film_size);
        height_ = reader.integer_or("height", 0, 1, most_film_size);
        if ((width_ > 0) != (height_ > 0))
            reader.fail(width_ > 0 ? "width" : "height", "the film's size is given by half",
                        "give both width and height");
        rendering.samples = static_cast<std::uint32_t>(reader.integer_or("spp", 64, 1, 1 << 30));
        if (reader.has("exposure_ev"))
            rendering.exposure_ev =
                reader.number("exposure_ev", NumberRange::within(-100.0, 100.0));
        for (const char* key : {"model", "wavelengths"})
            if (reader.has(key))
                add_method(reader, key, rendering.method);
        study_.rendering = rendering;
    }

    static void add_method(const TableReader& reader, const char* key, RenderMethod& method) {
        try {
            const RenderMethod given = parse_method(reader.text(key));
            method.model = given.model == Model::Auto ? method.model : given.model;
            method.comb_count = std::max(method.comb_count, given.comb_count);
            method.hero_count = std::max(method.hero_count, given.hero_count);
        } catch (const std::invalid_argument& error) {
            reader.fail(key, error.what());
        }
    }

    void read_measuring() {
        const TableReader reader = root_.table("measure", measure_keys);
        StudyMeasuring measuring;
        const NumberRange polar = NumberRange::within(0.0, 180.0);
        const auto angles = [&](const char* key, const NumberRange& range,
                                std::vector<double>& values) {
            if (!reader.has(key))
                return;
            values = numbers_at(reader.required(key), reader.file(), reader.position_of_key(key),
                                key, 0, range);
            if (values.empty())
                reader.fail(key, fmt::format("{} holds no angle", key), "give one at least");
        };
        angles("theta_i_deg", polar, measuring.theta_i_deg);
        angles("theta_o_deg", polar, measuring.theta_o_deg);
        angles("phi_deg", NumberRange::within(-360.0, 360.0), measuring.phi_deg);
        for (const auto& [key, values] : {std::pair("theta_i_deg", &measuring.theta_i_deg),
                                          std::pair("theta_o_deg", &measuring.theta_o_deg)})
            if (std::find(values->begin(), values->end(), 90.0) != values->end())
                reader.fail(key, fmt::format("{} of 90 degrees is along the surface", key),
                            "give less, or of a sheet's far side more");
        measuring.theta_i_given = reader.has("theta_i_deg");
        measuring.illuminants_given = reader.has("illuminants");
        if (measuring.illuminants_given)
            measuring.illuminants = illuminants_at(reader, "illuminants");
        if (reader.has("model"))
            measuring.model = model_from_name(
                reader.choice("model", {"auto", "adding", "weidlich-wilkie", "walk"}));
        measuring.samples = reader.integer_or("samples", 0, 1, 1 << 30);
        study_.measuring = measuring;
    }

    static std::vector<std::string> illuminants_at(const TableReader& reader, const char* key) {
        const std::vector<std::string> names = texts_at(reader, key);
        for (const std::string& name : names) {
            try {
                illuminant(name);
            } catch (const std::invalid_argument& error) {
                reader.fail(key, error.what());
            }
        }
        return names;
    }

    void read_base() {
        const bool has_scene = head_.has("scene");
        if (head_.has("preset") && (has_scene || head_.has("material")))
            head_.fail("preset", "a preset is a study's material by itself",
                       "leave scene and material away");
        if (!has_scene && !head_.has("material") && !head_.has("preset"))
            throw_input_error(head_.position(), "the study has nothing to change",
                              "add scene = \"scene.toml\", material = \"material.toml\" or "
                              "preset = \"...\"");
        if (has_scene)
            read_base_scene();
        else
            read_base_material();
        write_out_presets(study_.base);
        if (width_ > 0 && study_.base["film"].is_table()) {
            study_.base["film"].as_table()->insert_or_assign("width", width_);
            study_.base["film"].as_table()->insert_or_assign("height", height_);
        }
        if (study_.is_sample && study_.measuring && !study_.rendering)
            set_measured_bands();
        const Scene scene = scene_with(study_, {}); // refuses what is wrong in itself
        if (has_scene)
            choose_material(scene);
        if (study_.measuring)
            for (const Material& material : scene.materials)
                if (material.name == study_.material && !material.stack.is_sheet())
                    refuse_far_side(*study_.measuring);
    }

    /// Where nothing is rendered, spectra are used on the bands that are measured: those of the
    /// material's matrices, if it has any.
    void set_measured_bands() {
        const QuietLog quiet;
        const Scene scene = scene_with(study_, {});
        const auto grid = common_grid(matrices_of(scene.materials.front()));
        if (grid)
            study_.base["film"].as_table()->insert_or_assign("bands_nm",
                                                             toml::table{{"from", grid->from_nm},
                                                                         {"to", grid->to_nm()},
                                                                         {"step", grid->step_nm}});
    }

    /// What is opaque has no far side to be lit or seen from.
    void refuse_far_side(const StudyMeasuring& measuring) const {
        const TableReader reader = root_.table("measure", measure_keys);
        for (const auto& [key, angles] : {std::pair("theta_i_deg", &measuring.theta_i_deg),
                                          std::pair("theta_o_deg", &measuring.theta_o_deg)})
            for (const double angle : *angles)
                if (angle > 90.0)
                    reader.fail(
                        key,
                        fmt::format("{} of {:g} degrees lies beneath the material, which is opaque",
                                    key, angle),
                        "angles from the normal lie between 0 and below 90 degrees; a sheet "
                        "(substrate type \"none\") has two sides");
    }

    /// A file that a key names; input Error at the key when it is not there.
    fs::path named_file(const char* key) const {
        const SourcePosition at = head_.position_of_key(key);
        return LoadState().resolve(head_.text(key), at);
    }

    void read_base_scene() {
        study_.base_file = named_file("scene");
        study_.base = read_scene_table(study_.base_file);
    }

    void read_base_material() {
        study_.is_sample = true;
        study_.material = sample_material;
        if (head_.has("preset")) {
            const auto known = preset_names();
            const std::string preset = head_.text("preset");
            if (std::find(known.begin(), known.end(), preset) == known.end())
                head_.fail("preset", fmt::format("no preset is called \"{}\"", preset),
                           fmt::format("there are: {}", fmt::join(known, ", ")));
            study_.base_file = spectra_directory() / "materials" / (preset + ".toml");
        } else {
            study_.base_file = named_file("material");
        }
        study_.base = sample_scene(study_.base_file, width_ > 0 ? width_ : default_film_size,
                                   height_ > 0 ? height_ : default_film_size);
    }

    void choose_material(const Scene& scene) {
        std::vector<std::string> names;
        for (const Surface& surface : scene.surfaces)
            names.push_back(surface.name);
        if (!head_.has("material")) {
            if (names.size() == 1)
                study_.material = names.front();
            else if (study_.measuring)
                head_.fail("scene", fmt::format("the scene has {} materials", names.size()),
                           fmt::format("say which one is studied, material = one of: {}",
                                       fmt::join(names, ", ")));
            return;
        }
        study_.material = head_.text("material");
        if (std::find(names.begin(), names.end(), study_.material) == names.end())
            head_.fail("material", fmt::format("the scene has no material \"{}\"", study_.material),
                       fmt::format("there are: {}", fmt::join(names, ", ")));
    }

    TableReader root_, head_;
    Study study_;
    int width_ = 0, height_ = 0;
};

} // namespace

std::size_t Study::cell_count() const {
    std::size_t count = 1;
    for (const Sweep& sweep : sweeps)
        count = std::min(count * sweep.values.size(), 2 * most_study_cells); // does not overflow
    return count;
}

std::vector<std::size_t> Study::cell_values(std::size_t cell) const {
    std::vector<std::size_t> indices(sweeps.size());
    for (std::size_t k = sweeps.size(); k-- > 0;) {
        indices[k] = cell % sweeps[k].values.size();
        cell /= sweeps[k].values.size();
    }
    return indices;
}

Study load_study(const fs::path& file) {
    const toml::table table = read_scene_table(file);
    return StudyReader(table, file).study();
}

} // namespace reradiant
