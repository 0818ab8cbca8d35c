#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/base/output_ending.h"
#include "host/report/json_file.h"
#include "host/scene/lights/lamp_file.h"
#include "host/scene/model/named_files.h"
#include "host/view/export/exchange_files.h"
#include "host/view/lights/lights_page.h"
#include "host/view/view_page.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"
#include "tools/program/parse_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

struct ViewOptions {
    std::vector<fs::path> files, lamp_files;
    std::vector<std::string> presets, illuminants;
    bool gallery = false;
    fs::path output, glsl, osl, materialx, mitsuba;

    bool exchanges() const {
        return !glsl.empty() || !osl.empty() || !materialx.empty() || !mitsuba.empty();
    }
};

std::vector<Lamp> asked_lamps(const ViewOptions& options) {
    std::vector<Lamp> lamps;
    for (const std::string& list : options.illuminants) {
        std::istringstream names(list);
        for (std::string name; std::getline(names, name, ',');)
            try {
                lamps.push_back(lamp_from_text(name));
            } catch (const std::invalid_argument& error) {
                throw_input_error({}, fmt::format("--illuminant: {}", error.what()));
            }
    }
    for (const fs::path& file : options.lamp_files)
        lamps.push_back(read_lamp_file(file));
    return lamps;
}

bool is_image(const fs::path& file) {
    return lower_case_ending(file) == ".exr";
}

/// True where the page is of a picture, which it shows alone.
bool shows_image(const ViewOptions& options) {
    if (std::none_of(options.files.begin(), options.files.end(), is_image))
        return false;
    if (options.files.size() > 1 || !options.presets.empty() || options.gallery)
        throw_input_error({}, "a page shows one picture and nothing beside it",
                          "name the picture alone");
    if (options.exchanges() || options.output.empty())
        throw_input_error({}, "of a picture there is a page, and no shader",
                          "name a page: -o PAGE.html");
    return true;
}

/// What the command line says together: a material or the gallery, a page or a file, and for files
/// one of each.
void check_options(const ViewOptions& options) {
    const std::size_t count = options.files.size() + options.presets.size();
    if (options.gallery ? count > 0 : count == 0)
        throw_input_error({},
                          options.gallery ? "--gallery shows all presets, and no other material"
                                          : "view needs a MATERIAL.toml or a --preset",
                          options.gallery ? "leave the material out"
                                          : "--gallery shows all presets");
    if (options.output.empty() && !options.exchanges())
        throw_input_error({}, "nothing is asked for",
                          "name a page (-o PAGE.html) or a file (--glsl, --osl, --materialx, "
                          "--mitsuba)");
    if (options.exchanges() && (options.gallery || count > 1))
        throw_input_error({}, "shader files are of one material", "name one alone");
}

ViewedMaterial loaded(const std::string& name, const fs::path& file) {
    ViewedMaterial viewed{name, load_material(file)};
    if (viewed.material.position.file.empty())
        viewed.material.position.file = file.string();
    if (!viewed.material.name.empty())
        viewed.name = viewed.material.name;
    return viewed;
}

/// Presets that a page can show; a line says which are left out.
std::vector<ViewedMaterial> all_presets() {
    std::vector<ViewedMaterial> shown;
    std::vector<std::string> left_out;
    for (const std::string& name : preset_names()) {
        ViewedMaterial viewed = loaded(name, preset_file(name));
        if (is_shown_on_pages(viewed.material))
            shown.push_back(std::move(viewed));
        else
            left_out.push_back(name);
    }
    logging::info("left out, as no model of a page can show them: {}", fmt::join(left_out, ", "));
    return shown;
}

std::vector<ViewedMaterial> asked_materials(const ViewOptions& options) {
    if (options.gallery)
        return all_presets();
    std::vector<ViewedMaterial> materials;
    for (const fs::path& file : options.files)
        materials.push_back(loaded(file.stem().string(), file));
    for (const std::string& preset : options.presets)
        materials.push_back(loaded(preset, preset_file(preset)));
    return materials;
}

/// Errors of meaning have no place of their own: they are placed at the material's file.
template <typename Make>
auto placed_at(const ViewedMaterial& viewed, const Make& make) {
    try {
        return make();
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Input && error.position().file.empty())
            throw_input_error({viewed.material.position.file}, error.what());
        throw;
    }
}

/// Files that were made whole before any of them is written.
using MadeFiles = std::vector<std::pair<fs::path, std::string>>;

void add_exchange_files(MadeFiles& made, const ViewOptions& options, const ViewedMaterial& viewed,
                        const Lamp& lamp) {
    if (!options.glsl.empty())
        made.emplace_back(options.glsl, glsl_file(viewed, lamp));
    if (options.osl.empty() && options.materialx.empty() && options.mitsuba.empty())
        return;
    const LampColours colours = lamp_colours(viewed, lamp);
    using Maker = std::string (*)(const LampColours&);
    const std::pair<fs::path, Maker> files[] = {{options.osl, osl_file},
                                                {options.materialx, materialx_file},
                                                {options.mitsuba, mitsuba_file}};
    for (const auto& [file, make] : files)
        if (!file.empty())
            made.emplace_back(file, make(colours));
}

std::string page_title(const ViewOptions& options, const std::vector<ViewedMaterial>& materials) {
    if (options.gallery)
        return "Presets of Reradiant";
    std::vector<std::string> names;
    for (const ViewedMaterial& viewed : materials)
        names.push_back(viewed.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void write_files(const MadeFiles& made, nlohmann::ordered_json json, const CommonOptions& common) {
    for (const auto& [file, text] : made) {
        write_text_atomically(file, text);
        json["bytes"][file.string()] = text.size();
    }
    write_json(common.json, json);
    if (!common.quiet)
        for (const auto& [file, text] : made)
            fmt::print("{}: {} kB\n", file.string(), (text.size() + 999) / 1000);
}

int run_view(const ViewOptions& options, const CommonOptions& common) {
    const bool is_of_image = shows_image(options);
    if (!is_of_image)
        check_options(options);
    std::vector<fs::path> inputs = options.files;
    inputs.insert(inputs.end(), options.lamp_files.begin(), options.lamp_files.end());
    const std::vector<NamedOutput> outputs{{"-o", options.output, {".html", ".htm"}},
                                           {"--glsl", options.glsl, {".glsl"}},
                                           {"--osl", options.osl, {".osl"}},
                                           {"--materialx", options.materialx, {".mtlx"}},
                                           {"--mitsuba", options.mitsuba, {".xml"}}};
    check_outputs(common, outputs, inputs);
    std::vector<Lamp> lamps = asked_lamps(options);
    if (options.exchanges() && lamps.size() > 1)
        throw_input_error({}, "shader files are for one lamp", "name one alone");
    if (is_of_image) {
        const fs::path& image = options.files.front();
        write_files({{options.output, lights_page({image, std::move(lamps)})}},
                    {{"layers", light_layers_of(image).size()}}, common);
        return 0;
    }
    const std::vector<ViewedMaterial> materials = asked_materials(options);
    check_outputs(common, outputs, named_files());
    MadeFiles made;
    placed_at(materials.front(), [&] {
        if (!options.output.empty())
            made.emplace_back(options.output, view_page({page_title(options, materials), materials,
                                                         lamps, options.gallery}));
        add_exchange_files(made, options, materials.front(),
                           lamps.empty() ? lamp_from_text("D65") : lamps.front());
    });
    write_files(made, {{"materials", materials.size()}}, common);
    return 0;
}

void add_file_options(Command& command, ViewOptions& options) {
    command.option("-o,--output", options.output,
                   "HTML file to write: a page that fetches nothing");
    command.option("--glsl", options.glsl,
                   "write the model as GLSL ES 3.00 functions (.glsl), for one lamp");
    command.option("--osl", options.osl,
                   "write an Open Shading Language shader (.osl), for one lamp");
    command.option("--materialx", options.materialx,
                   "write the nearest OpenPBR surface as MaterialX (.mtlx), for one lamp");
    command.option("--mitsuba", options.mitsuba,
                   "write the nearest BSDF of Mitsuba 3 (.xml), for one lamp");
}

} // namespace

void add_view_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<ViewOptions>();
    Command command = program.add_command(
        "view",
        "Makes a page to turn a material and its lamp in a browser, or a picture's lights up "
        "and down; shader files");
    command.option("FILE", options->files,
                   "TOML files with one [material] each, or one spectral EXR, whose light groups "
                   "(`render --light-groups`) get sliders");
    command
        .option("--preset", options->presets,
                "a material of spectra/materials by name (repeatable)")
        .one_at_a_time();
    command.flag("--gallery", options->gallery, "all presets that a page can show, as tiles");
    add_file_options(command, *options);
    command
        .option("--illuminant", options->illuminants,
                "lamps between commas, as `colour` takes them: first in the page's list, and the "
                "one of shader files (D65 where none is given)")
        .one_at_a_time();
    command
        .option("--lamp", options->lamp_files,
                "file of a lamp's spectrum (repeatable); outside its data it is dark")
        .one_at_a_time();
    command.footer("Examples:\n"
                   "  reradiant view lacquer.toml --illuminant D65,L:365:10 -o lacquer.html\n"
                   "  reradiant view room.exr -o room.html\n"
                   "  reradiant view --preset red-lacquer --materialx lacquer.mtlx --osl "
                   "lacquer.osl");
    command.callback(
        [options, &context] { context.exit_code = run_view(*options, context.common); });
}

} // namespace reradiant
