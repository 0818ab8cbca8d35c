#include "host/scene/mitsuba/mitsuba_scene.h"

#include "host/base/logging.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace reradiant {

namespace {

/// Indices of refraction that Mitsuba's documentation lists ("Smooth dielectric material").
const std::map<std::string, double> named_ior{
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.575},       {"diamond", 2.419}};
constexpr int most_nested_bsdfs = 16;
const std::map<std::string, std::string> metals{
    {"Ag", "silver"}, {"Au", "gold"}, {"Cu", "copper"}, {"Al", "aluminium"}};

double ior_of(const MitsubaObject& bsdf, const std::string& name, const std::string& otherwise) {
    const pugi::xml_node found = bsdf.find(name);
    if (found && std::string(found.name()) == "float")
        return bsdf.document().number(found, "value");
    const std::string material = bsdf.text_or(name, otherwise);
    const auto known = named_ior.find(material);
    if (known != named_ior.end())
        return known->second;
    std::vector<std::string> names;
    for (const auto& [each, value] : named_ior)
        names.push_back(each);
    bsdf.document().fail(found, fmt::format("no index of refraction is known for \"{}\"", material),
                         fmt::format("give a <float>, or one of: {}", fmt::join(names, ", ")));
}

/// Mitsuba's exterior stands where this program has vacuum: only the ratio matters.
double relative_ior(const MitsubaObject& bsdf, const std::string& inside) {
    const double ior = ior_of(bsdf, "int_ior", inside) / ior_of(bsdf, "ext_ior", "air");
    if (!(ior > 0.0))
        bsdf.fail(fmt::format("the {} has a relative index of refraction of {}", bsdf.title(), ior),
                  "int_ior and ext_ior must be above 0");
    return ior;
}

/// Both of Mitsuba's rough models follow one scattering event at a surface.
void insert_roughness(toml::table& into, const MitsubaObject& bsdf) {
    for (const char* name : {"alpha_u", "alpha_v"})
        if (const pugi::xml_node found = bsdf.find(name))
            bsdf.document().fail(found, "anisotropic roughness is not supported", "give alpha");
    into.insert(bsdf.key("alpha", "alpha"), bsdf.number_or("alpha", 0.1));
    const std::string distribution = bsdf.text_or("distribution", "beckmann");
    if (distribution != "beckmann" && distribution != "ggx")
        bsdf.document().fail(bsdf.find("distribution"),
                             fmt::format("the distribution \"{}\" is not known", distribution),
                             "use beckmann or ggx");
    into.insert("distribution", distribution);
    into.insert("scattering", "single");
    bsdf.flag_or("sample_visible", true); // says how to sample, not what
}

/// A factor on a reflection; this program has none.
void require_one(const MitsubaObject& bsdf, const std::string& name) {
    const pugi::xml_node found = bsdf.find(name);
    if (!found)
        return;
    const std::string tag = found.name();
    const bool plain = (tag == "float" || tag == "spectrum" || tag == "rgb") &&
                       bsdf.document().has(found, "value") && !bsdf.document().has(found, "type");
    const auto is_one = [](double value) { return value == 1.0; };
    const std::vector<double> values =
        plain ? bsdf.document().numbers(found, "value", 0) : std::vector<double>{0.0};
    if (!std::all_of(values.begin(), values.end(), is_one))
        bsdf.document().fail(found, fmt::format("{} other than 1 is not supported", name),
                             "leave it out: it breaks the energy balance");
}

void add_layer(toml::table& material, toml::table layer) {
    toml::array layers;
    layers.push_back(std::move(layer));
    if (const toml::array* below = material["layer"].as_array())
        for (const toml::node& node : *below)
            layers.push_back(*node.as_table());
    material.insert_or_assign("layer", std::move(layers));
}

toml::table diffuse(const MitsubaObject& bsdf, const char* property, MitsubaScene& scene) {
    toml::table substrate{{"type", "lambert"}};
    insert_mitsuba_reflectance(substrate, "reflectance", bsdf, property, 0.5, scene);
    return toml::table{{"substrate", std::move(substrate)}};
}

/// Applies take_linear_plastic and refuses here a reflectance that the scene's own reader would
/// refuse later.
bool has_linear_base(const MitsubaObject& bsdf, toml::table& material, const toml::table& layer) {
    try {
        return take_linear_plastic(*material["substrate"].as_table(), layer);
    } catch (const std::invalid_argument& error) {
        bsdf.document().fail(bsdf.element(), fmt::format("diffuse_reflectance: {}", error.what()),
                             "give a reflectance, 0 to 1");
    }
}

toml::table plastic(const MitsubaObject& bsdf, bool rough, MitsubaScene& scene) {
    toml::table material = diffuse(bsdf, "diffuse_reflectance", scene);
    require_one(bsdf, "specular_reflectance");
    toml::table layer;
    layer.insert(bsdf.key("ior", "int_ior"), relative_ior(bsdf, "polypropylene"));
    if (rough)
        insert_roughness(layer, bsdf);
    if (!bsdf.flag_or("nonlinear", false) && !has_linear_base(bsdf, material, layer))
        logging::warn("{}: the {} is rendered as with nonlinear = true: this program counts every "
                      "reflection between coat and base with the base's reflectance",
                      bsdf.document().position(bsdf.element()).text(), bsdf.title());
    add_layer(material, std::move(layer));
    return material;
}

toml::table conductor(const MitsubaObject& bsdf, bool rough, MitsubaScene& scene) {
    toml::table substrate{{"type", "conductor"}};
    const std::string name = bsdf.text_or("material", "none");
    require_one(bsdf, "specular_reflectance");
    const auto metal = metals.find(name);
    if (metal != metals.end()) {
        substrate.insert("metal", metal->second);
    } else if (name != "none") {
        bsdf.document().fail(bsdf.find("material"),
                             fmt::format("the metal \"{}\" is not known", name),
                             "use Ag, Al, Au or Cu, or give eta and k");
    } else if (bsdf.has("eta") != bsdf.has("k")) {
        bsdf.fail(fmt::format("the {} has one of eta and k", bsdf.title()), "give both");
    } else if (bsdf.has("eta")) {
        insert_mitsuba_spectrum(substrate, "ior", bsdf, "eta", scene);
        insert_mitsuba_spectrum(substrate, "kappa", bsdf, "k", scene);
    } else { // Mitsuba's perfect mirror; an ior of 0 is none here, this one absorbs 4e-6
        substrate.insert("ior", 1e-6);
        substrate.insert("kappa", 1.0);
    }
    if (rough)
        insert_roughness(substrate, bsdf);
    return toml::table{{"substrate", std::move(substrate)}};
}

toml::table material_of(const pugi::xml_node& element, MitsubaScene& scene);

toml::table nested_material(const MitsubaObject& bsdf, MitsubaScene& scene) {
    const auto inside = bsdf.nested("bsdf");
    if (scene.bsdf_depth > most_nested_bsdfs)
        bsdf.fail(fmt::format("the {} holds itself", bsdf.title()), "let no <ref> lead back to it");
    if (inside.size() != 1)
        bsdf.fail(fmt::format("the {} has {} bsdfs", bsdf.title(), inside.size()),
                  "give one; another one for the back is not supported");
    scene.nested_bsdfs.insert(inside.front().offset_debug());
    ++scene.bsdf_depth;
    toml::table material = material_of(inside.front(), scene);
    --scene.bsdf_depth;
    return material;
}

/// The coats of Mitsuba 0.6, with the names as Mitsuba 3 would spell them.
toml::table coating(const MitsubaObject& bsdf, bool rough, MitsubaScene& scene) {
    toml::table material = nested_material(bsdf, scene);
    toml::table layer;
    layer.insert(bsdf.key("ior", "int_ior"), relative_ior(bsdf, "bk7"));
    layer.insert(bsdf.key("thickness", "thickness"), bsdf.number_or("thickness", 1.0));
    if (bsdf.has("sigma_a"))
        insert_mitsuba_spectrum(layer, "absorption", bsdf, "sigma_a", scene);
    require_one(bsdf, "specular_reflectance");
    if (rough)
        insert_roughness(layer, bsdf);
    add_layer(material, std::move(layer));
    return material;
}

toml::table material_of(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject bsdf(scene.document(), element);
    const std::string& type = bsdf.type();
    toml::table material;
    if (type == "diffuse")
        material = diffuse(bsdf, "reflectance", scene);
    else if (type == "plastic" || type == "roughplastic")
        material = plastic(bsdf, type == "roughplastic", scene);
    else if (type == "conductor" || type == "roughconductor")
        material = conductor(bsdf, type == "roughconductor", scene);
    else if (type == "coating" || type == "roughcoating")
        material = coating(bsdf, type == "roughcoating", scene);
    else if (type == "twosided")
        material = nested_material(bsdf, scene);
    else
        bsdf.refuse_type({"diffuse", "plastic", "roughplastic", "conductor", "roughconductor",
                          "coating", "roughcoating", "twosided"});
    bsdf.finish();
    return material;
}

} // namespace

std::string mitsuba_material(const pugi::xml_node& element, MitsubaScene& scene) {
    const auto known = scene.material_names.find(element.offset_debug());
    if (known != scene.material_names.end())
        return known->second;
    const MitsubaDocument& document = scene.document();
    const std::string name = scene.unique_name(
        document.has(element, "id") ? document.text(element, "id") : std::string("material"));
    scene.material_names.emplace(element.offset_debug(), name);
    scene.texture_met.clear();
    toml::table material = material_of(element, scene);
    scene.material_textures[name] = scene.texture_met;
    material.insert("name", name);
    scene.add("material", std::move(material), element);
    return name;
}

std::string mitsuba_default_material(MitsubaScene& scene) {
    const auto [entry, is_new] = scene.material_names.emplace(-1, "default");
    if (is_new) {
        entry->second = scene.unique_name("default");
        scene.add(
            "material",
            toml::table{{"name", entry->second},
                        {"substrate", toml::table{{"type", "lambert"}, {"reflectance", 0.5}}}},
            scene.document().scene());
    }
    return entry->second;
}

} // namespace reradiant
