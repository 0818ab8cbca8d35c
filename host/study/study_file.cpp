#include "host/study/study_file.h"

#include "host/paths.h"
#include "host/scene/load_state.h"
#include "host/scene/scene_table.h"
#include "host/study/sample_scene.h"
#include "host/study/sweep_apply.h"
#include "host/study/sweep_target.h"
#include "host/study/toml_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_cells = 10000;
constexpr int most_film_size = 4096;
constexpr int default_film_size = 96;
constexpr std::size_t longest_label = 40;

std::string one_line(const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_table<decltype(value)>)
            text << toml::toml_formatter(value, toml::format_flags::none);
        else
            text << value;
    });
    std::string line = text.str();
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line.size() > longest_label ? line.substr(0, longest_label) + "..." : line;
}

/// What a value is called on pages and in tables.
std::string label_of(const toml::node& node) {
    if (const auto text = node.value<std::string>(); text && node.is_string())
        return fs::path(*text).stem().string() == *text ? *text
                                                        : fs::path(*text).filename().string();
    if (const auto number = node.value<double>())
        return fmt::format("{:g}", *number);
    if (const toml::table* const table = node.as_table()) {
        for (const char* key : {"illuminant", "file"})
            if (const auto name = (*table)[key].value<std::string>())
                return fs::path(*name).filename().string();
        if (const auto line = (*table)["line_nm"].value<double>())
            return fmt::format("{:g} nm", *line);
        if (const auto kelvin = (*table)["blackbody_kelvin"].value<double>())
            return fmt::format("{:g} K", *kelvin);
    }
    return one_line(node);
}

/// Files that the study names start at its folder, not at the scene's.
void make_files_absolute(toml::node& node, const fs::path& folder) {
    if (toml::array* const array = node.as_array())
        for (toml::node& element : *array)
            make_files_absolute(element, folder);
    toml::table* const table = node.as_table();
    if (table == nullptr)
        return;
    for (auto&& [key, value] : *table) {
        std::error_code ignored;
        if (toml::value<std::string>* const name = value.as_string();
            name != nullptr && key.str() == "file" && fs::exists(folder / **name, ignored))
            *name = fs::absolute(folder / **name).string();
        else
            make_files_absolute(value, folder);
    }
}

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
            read_sweep(*table);
        check_sweeps();
        return std::move(study_);
    }

private:
    fs::path beside(const std::string& name) const { return study_.file.parent_path() / name; }

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
        rendering.exposure_ev =
            reader.number_or("exposure_ev", 0.0, NumberRange::within(-100.0, 100.0));
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
        } catch (const Error& error) {
            reader.fail(key, error.what());
        }
    }

    void read_measuring() {
        const TableReader reader = root_.table(
            "measure", {"theta_i_deg", "theta_o_deg", "phi_deg", "illuminants", "model"});
        StudyMeasuring measuring;
        const NumberRange polar{.low = 0.0, .high = 90.0, .high_is_allowed = false};
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
        if (reader.has("illuminants"))
            measuring.illuminants = read_names(reader, "illuminants");
        if (reader.has("model"))
            measuring.model =
                model_from_name(reader.choice("model", {"auto", "adding", "weidlich-wilkie"}));
        study_.measuring = measuring;
    }

    std::vector<std::string> read_names(const TableReader& reader, const char* key) const {
        const toml::array* const array = reader.required(key).as_array();
        if (array == nullptr || array->empty())
            reader.fail(key, fmt::format("{} is no list of names", key), "write [\"...\", ...]");
        std::vector<std::string> names;
        for (const toml::node& element : *array) {
            if (!element.is_string())
                throw_input_error(
                    position_of(reader.file(), element.source()),
                    fmt::format("an element of {} is {}", key, toml_type_name(element)),
                    "write a string");
            names.push_back(*element.value<std::string>());
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
        const Scene scene = scene_with(study_, {}); // refuses what is wrong in itself
        if (has_scene)
            choose_material(scene);
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

    void read_sweep(const toml::table& table) {
        const TableReader reader(table, root_.file(), "[[sweep]]", sweep_keys);
        Sweep sweep;
        resolve_target(reader, study_, sweep);
        const toml::array* const values = reader.required("values").as_array();
        if (values == nullptr || values->empty())
            reader.fail("values", values == nullptr ? "values is no list" : "the sweep is empty",
                        "give the values that the parameter takes: values = [1, 2]");
        std::vector<std::string> names;
        if (reader.has("names"))
            names = read_names(reader, "names");
        if (!names.empty() && names.size() != values->size())
            reader.fail("names",
                        fmt::format("{} names for {} values", names.size(), values->size()),
                        "give as many names as values");
        for (std::size_t i = 0; i < values->size(); ++i)
            add_value(sweep, (*values)[i], names.empty() ? "" : names[i]);
        study_.sweeps.push_back(std::move(sweep));
    }

    void add_value(Sweep& sweep, const toml::node& node, const std::string& name) const {
        SweepValue value;
        value.position = position_of(root_.file(), node.source());
        value.label = name.empty() ? label_of(node) : name;
        value.boxed.push_back(node);
        std::error_code ignored;
        if (sweep.kind == SweepKind::Matrix && node.is_string()) {
            const fs::path file = beside(*node.value<std::string>());
            if (fs::exists(file, ignored))
                *value.boxed[0].as_string() = fs::absolute(file).string();
        }
        make_files_absolute(value.boxed, study_.file.parent_path());
        for (const SweepValue& other : sweep.values)
            if (one_line(other.node()) == one_line(value.node()) || other.label == value.label)
                throw_input_error(value.position,
                                  fmt::format("the sweep has the value {} twice", value.label),
                                  "leave one away, or tell them apart by names = [...]");
        sweep.values.push_back(std::move(value));
    }

    void check_sweeps() const {
        if (study_.sweeps.empty())
            throw_input_error({study_.file.string(), 1, 1}, "the study sweeps nothing",
                              "add a [[sweep]] with parameter and values");
        for (std::size_t k = 0; k < study_.sweeps.size(); ++k) {
            const Sweep& sweep = study_.sweeps[k];
            for (std::size_t j = 0; j < k; ++j)
                if (targets_collide(study_.sweeps[j], sweep))
                    throw_input_error(sweep.position,
                                      fmt::format("two sweeps contradict each other: {} and {} "
                                                  "change the same thing",
                                                  study_.sweeps[j].label, sweep.label),
                                      "leave one away");
            refuse_given_twice(sweep);
            check_usable(sweep);
        }
        if (study_.cell_count() > most_cells)
            throw_input_error(study_.sweeps.front().position,
                              fmt::format("the sweeps have {} combinations", study_.cell_count()),
                              fmt::format("at most {}", most_cells));
    }

    /// What is swept cannot be fixed for measurements as well.
    void refuse_given_twice(const Sweep& sweep) const {
        const std::pair<SweepKind, const char*> given[] = {{SweepKind::Angle, "theta_i_deg"},
                                                           {SweepKind::Illuminant, "illuminants"}};
        for (const auto& [kind, key] : given)
            if (sweep.kind == kind && study_.measuring &&
                root_.plain_table("measure").contains(key))
                throw_input_error(
                    sweep.position,
                    fmt::format("{} is swept, and fixed by {} of [measure]", sweep.label, key),
                    "leave one away");
    }

    /// A value may be wrong for itself: then its cells fail. When none is right the sweep is.
    void check_usable(const Sweep& sweep) const {
        std::optional<Error> first;
        for (const SweepValue& value : sweep.values) {
            try {
                scene_with(study_, {{&sweep, &value}});
                return;
            } catch (const Error& error) {
                if (!first)
                    first = error;
            }
        }
        throw_input_error(
            sweep.values.front().position,
            fmt::format("no value of the sweep {} can be used: {}", sweep.label, first->what()));
    }

    TableReader root_, head_;
    Study study_;
    int width_ = 0, height_ = 0;
};

} // namespace

std::size_t Study::cell_count() const {
    std::size_t count = 1;
    for (const Sweep& sweep : sweeps)
        count = std::min(count * sweep.values.size(), 2 * most_cells); // does not overflow
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
