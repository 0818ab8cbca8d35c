#include "host/scene/mitsuba/mitsuba_import.h"

#include "host/base/logging.h"
#include "host/scene/document/toml_document.h"
#include "host/scene/mitsuba/mitsuba_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

namespace reradiant {

namespace fs = std::filesystem;

std::string MitsubaScene::file_name(const MitsubaObject& owner, const std::string& property) const {
    const pugi::xml_node found = owner.find(property);
    if (!found)
        owner.fail(fmt::format("the {} has no {}", owner.title(), property),
                   fmt::format("add <string name=\"{}\" value=\"...\"/>", property));
    return file_name(found, document_.text(found, "value"));
}

std::string MitsubaScene::file_name(const pugi::xml_node& element, const std::string& given) const {
    const fs::path folder = document_.file().parent_path();
    const fs::path file = fs::path(given).is_absolute() ? fs::path(given) : folder / given;
    std::error_code failure;
    if (!fs::is_regular_file(file, failure))
        document_.fail(element, fmt::format("cannot open \"{}\": no such file", given),
                       fmt::format("looked for {}", file.string()));
    if (fs::path(given).is_absolute())
        return given;
    const fs::path relative = fs::relative(file, base_.empty() ? fs::path(".") : base_, failure);
    return failure || relative.empty() ? fs::absolute(file).string() : relative.string();
}

void MitsubaScene::add(const char* list, toml::table entry, const pugi::xml_node& element) {
    place_keys(entry, document_.position(element));
    if (!table_.contains(list))
        table_.insert(list, toml::array{});
    table_[list].as_array()->push_back(std::move(entry));
}

void MitsubaScene::set(const char* key, toml::table entry, const pugi::xml_node& element) {
    const SourcePosition position = document_.position(element);
    place_keys(entry, position);
    table_.insert_or_assign(placed_key(key, position), std::move(entry));
}

std::string MitsubaScene::unique_name(const std::string& wanted) {
    const int count = ++names_[wanted];
    if (count == 1)
        return wanted;
    return unique_name(fmt::format("{}-{}", wanted, count));
}

toml::array toml_vector(const Eigen::Vector3d& v) {
    // Rotations by right angles leave rounding noise where a person would have written 0.
    const double smallest = 1e-15 * v.cwiseAbs().maxCoeff();
    const auto part = [&](int k) { return std::abs(v[k]) <= smallest ? 0.0 : v[k]; };
    return toml::array{part(0), part(1), part(2)};
}

bool is_mitsuba_scene(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".xml";
}

namespace {

void add_element(const pugi::xml_node& element, MitsubaScene& scene) {
    const std::string tag = element.name();
    if (tag == "shape")
        add_mitsuba_shape(element, scene);
    else if (tag == "emitter" && element.attribute("type").as_string() != std::string("area"))
        add_mitsuba_emitter(element, scene);
    else if (tag == "sensor")
        add_mitsuba_sensor(element, scene);
    else if (tag == "integrator")
        add_mitsuba_integrator(element, scene);
    else if (tag != "default" && tag != "texture" && tag != "spectrum" && tag != "emitter" &&
             tag != "bsdf") // used where referred to
        scene.document().fail(element, fmt::format("<{}> is not supported", tag),
                              "a scene holds sensor, integrator, emitters, shapes, bsdfs");
}

/// Adds an element. A spectrum or a reflectance may refuse it without knowing its place; such an
/// error is placed at the element.
void add_element_in_place(const pugi::xml_node& element, MitsubaScene& scene) {
    try {
        add_element(element, scene);
    } catch (const std::invalid_argument& error) {
        scene.document().fail(element, error.what());
    }
}

/// Warns of each bsdf that no shape refers to; such a bsdf may be of any kind.
void warn_of_unused_bsdfs(const MitsubaScene& scene) {
    for (const pugi::xml_node& bsdf : scene.document().scene().children("bsdf"))
        if (scene.material_names.count(bsdf.offset_debug()) == 0 &&
            scene.nested_bsdfs.count(bsdf.offset_debug()) == 0)
            logging::warn("{}: the bsdf is left out: no shape refers to it",
                          scene.document().position(bsdf).text());
}

} // namespace

toml::table mitsuba_scene_table(const fs::path& file, const fs::path& base) {
    const MitsubaDocument document(file);
    MitsubaScene scene(document, base);
    for (const pugi::xml_node& element : document.scene().children())
        if (element.type() == pugi::node_element)
            add_element_in_place(element, scene);
    warn_of_unused_bsdfs(scene);
    if (!scene.table().contains("camera"))
        document.fail(document.scene(), "the scene has no sensor",
                      "add a <sensor type=\"perspective\">");
    return std::move(scene.table());
}

} // namespace reradiant
