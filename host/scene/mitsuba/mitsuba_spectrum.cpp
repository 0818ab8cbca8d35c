#include "host/scene/document/toml_document.h"
#include "host/scene/mitsuba/mitsuba_scene.h"
#include "host/spectral/spectrum/spectrum_formats.h"
#include "host/spectral/text/wavelength_unit.h"
#include "reradiant/colour.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace reradiant {

namespace {

using Rgb = std::array<double, 3>;

/// W m^-2 sr^-1 per nm of a blackbody, CODATA 2018.
double planck_per_nm(double kelvin, double nm) {
    constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    const double m = nm * 1e-9;
    return 2.0 * h * c * c / std::pow(m, 5) / std::expm1(h * c / (m * k * kelvin)) * 1e-9;
}

toml::table d65(double scale) {
    return toml::table{{"illuminant", "D65"}, {"scale", scale}};
}

toml::table table_of(const std::vector<double>& nm, const std::vector<double>& value) {
    toml::array wavelengths, values;
    for (std::size_t k = 0; k < nm.size(); ++k) {
        wavelengths.push_back(nm[k]);
        values.push_back(value[k]);
    }
    return toml::table{{"nm", std::move(wavelengths)}, {"value", std::move(values)}};
}

Rgb read_rgb(const MitsubaDocument& document, const pugi::xml_node& element,
             const char* attribute) {
    const std::string text = document.text(element, attribute);
    if (text.starts_with("#")) {
        unsigned code = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, failure] = std::from_chars(text.data() + 1, end, code, 16);
        if (text.size() != 7 || failure != std::errc{} || stop != end)
            document.fail(element, fmt::format("\"{}\" is not a colour", text),
                          "write #rrggbb or three numbers");
        // sRGB codes (IEC 61966-2-1)
        const auto channel = [&](int shift) {
            const double v = ((code >> shift) & 0xffu) / 255.0;
            return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        };
        return {channel(16), channel(8), channel(0)};
    }
    const auto given = document.numbers(element, attribute, 0);
    if (given.size() == 1)
        return {given[0], given[0], given[0]};
    if (given.size() != 3 || *std::min_element(given.begin(), given.end()) < 0.0)
        document.fail(element, fmt::format("\"{}\" is not a colour", text),
                      "write three numbers, none below 0");
    return {given[0], given[1], given[2]};
}

/// D65 times the reflectance of the colour, every 5 nm where D65 has data.
toml::table rgb_emission(const Rgb& rgb) {
    const double largest = *std::max_element(rgb.begin(), rgb.end());
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
        return d65(largest);
    const Spectrum light = illuminant_with_luminance("D65", largest);
    const Spectrum hue =
        reflectance_from_rgb({rgb[0] / largest, rgb[1] / largest, rgb[2] / largest});
    std::vector<double> nm, value;
    for (int at = 300; at <= 830; at += 5) {
        nm.push_back(at);
        value.push_back(light(at) * hue(at));
    }
    return table_of(nm, value);
}

struct Samples {
    std::vector<double> nm, value;
};

/// `Beyond` says which values a sampled spectrum has beyond its samples.
enum class Beyond { Zero, EndValues };

/// Returns the table of samples. Mitsuba takes 0 beyond the samples and this program their end
/// values: for Beyond::Zero, zeros are added up to Mitsuba's range of wavelengths.
toml::table samples_of(Samples samples, Beyond beyond, const SourcePosition& at) {
    constexpr double from_nm = 360.0, to_nm = 830.0, edge_nm = 1e-3;
    auto& [nm, value] = samples;
    if (!nm.empty()) // before zeros hide where the samples lie
        require_plausible_range(nm.front(), nm.back(), UnitSource::Fixed, at);
    if (beyond == Beyond::Zero && nm.front() > from_nm + edge_nm) {
        nm.insert(nm.begin(), {from_nm, nm.front() - edge_nm});
        value.insert(value.begin(), {0.0, 0.0});
    }
    if (beyond == Beyond::Zero && nm.back() < to_nm - edge_nm) {
        nm.insert(nm.end(), {nm.back() + edge_nm, to_nm});
        value.insert(value.end(), {0.0, 0.0});
    }
    return table_of(nm, value);
}

/// Reads "400:0.1 700:0.5", or a number alone.
Samples pairs(const MitsubaDocument& document, const pugi::xml_node& element) {
    std::string text = document.text(element, "value");
    std::replace(text.begin(), text.end(), ':', ' ');
    std::vector<double> nm, value;
    const char* at = text.data();
    for (const char* const end = at + text.size(); at != end;) {
        if (*at == ' ' || *at == ',' || *at == '\n' || *at == '\t' || *at == '\r') {
            ++at;
            continue;
        }
        double number = 0.0;
        const auto [stop, failure] = std::from_chars(at, end, number);
        if (failure != std::errc{} || !std::isfinite(number))
            document.fail(element, "value is not made of WAVELENGTH:VALUE pairs",
                          "write for instance \"400:0.1, 700:0.5\"");
        (nm.size() > value.size() ? value : nm).push_back(number);
        at = stop;
    }
    if (nm.empty() || nm.size() != value.size() ||
        std::adjacent_find(nm.begin(), nm.end(), std::greater_equal<>()) != nm.end())
        document.fail(element, "value is not made of ascending WAVELENGTH:VALUE pairs",
                      "write for instance \"400:0.1, 700:0.5\"");
    return {std::move(nm), std::move(value)};
}

std::vector<double> number_list(const MitsubaObject& spectrum, const std::string& name) {
    const pugi::xml_node found = spectrum.find(name);
    if (!found)
        spectrum.fail(fmt::format("the {} has no {}", spectrum.title(), name),
                      fmt::format("add <string name=\"{}\" value=\"...\"/>", name));
    return spectrum.document().numbers(found, "value", 0);
}

[[noreturn]] void refuse_order(const MitsubaObject& spectrum, double before, double after) {
    const bool is_listed = spectrum.type() == "irregular";
    const pugi::xml_node at = spectrum.find(is_listed ? "wavelengths" : "wavelength_max");
    spectrum.document().fail(at ? at : spectrum.element(),
                             fmt::format("{} nm follows {} nm", after, before),
                             is_listed ? "wavelengths must ascend, each once"
                                       : "wavelength_max must be above wavelength_min");
}

Samples sampled(const MitsubaObject& spectrum) {
    std::vector<double> values = number_list(spectrum, "values");
    std::vector<double> nm;
    if (spectrum.type() == "irregular") {
        nm = number_list(spectrum, "wavelengths");
    } else {
        const double first = spectrum.number_or("wavelength_min", 360.0),
                     last = spectrum.number_or("wavelength_max", 830.0);
        for (std::size_t k = 0; k < values.size(); ++k)
            nm.push_back(first +
                         (last - first) * static_cast<double>(k) /
                             static_cast<double>(std::max<std::size_t>(values.size(), 2) - 1));
    }
    if (nm.size() != values.size())
        spectrum.fail(
            fmt::format("{} wavelengths stand beside {} values", nm.size(), values.size()),
            "give one for each");
    const auto back = std::adjacent_find(nm.begin(), nm.end(), std::greater_equal<>());
    if (back != nm.end())
        refuse_order(spectrum, back[0], back[1]);
    return {std::move(nm), std::move(values)};
}

toml::table spectrum_file(const pugi::xml_node& element, const MitsubaScene& scene, Beyond beyond) {
    const std::string given = scene.document().text(element, "filename");
    std::string name = scene.file_name(element, given);
    if (beyond == Beyond::EndValues)
        return toml::table{{"file", std::move(name)}};
    NumberTable table = read_spectrum_table(scene.document().file().parent_path() / given);
    return samples_of({std::move(table.columns[0]), std::move(table.columns[1])}, beyond,
                      scene.document().position(element));
}

toml::table blackbody(const MitsubaObject& spectrum) {
    const double kelvin = spectrum.number_or("temperature", 5000.0);
    try {
        const Spectrum shape = Spectrum::blackbody(kelvin, planck_per_nm(kelvin, 560.0));
        return toml::table{{"blackbody_kelvin", kelvin}, {"scale", xyz_of(shape)[1]}};
    } catch (const std::invalid_argument& error) {
        spectrum.fail(error.what(), "give a temperature in kelvin that glows");
    }
}

/// A <spectrum> of a type of its own.
toml::table plugin(const pugi::xml_node& element, MitsubaScene& scene, Beyond beyond) {
    const MitsubaObject spectrum(scene.document(), element);
    toml::table made;
    if (spectrum.type() == "uniform") {
        const double value = spectrum.number_or("value", 1.0);
        made = table_of({550.0}, {value});
    } else if (spectrum.type() == "d65") {
        made = d65(spectrum.number_or("scale", 1.0));
    } else if (spectrum.type() == "blackbody") {
        made = blackbody(spectrum);
    } else if (spectrum.type() == "regular" || spectrum.type() == "irregular") {
        made = samples_of(sampled(spectrum), beyond, scene.document().position(element));
    } else {
        spectrum.refuse_type({"uniform", "d65", "blackbody", "regular", "irregular"});
    }
    spectrum.finish();
    return made;
}

pugi::xml_node resolved(const pugi::xml_node& element, const MitsubaScene& scene) {
    if (std::string(element.name()) != "ref")
        return element;
    return scene.document().with_id(scene.document().text(element, "id"), element);
}

/// A <spectrum> in any form; a number alone is the same at every wavelength.
toml::table spectrum_of(const pugi::xml_node& element, MitsubaScene& scene, Beyond beyond) {
    const MitsubaDocument& document = scene.document();
    if (document.has(element, "type"))
        return plugin(element, scene, beyond);
    if (document.has(element, "filename"))
        return spectrum_file(element, scene, beyond);
    if (document.text(element, "value").find(':') != std::string::npos)
        return samples_of(pairs(document, element), beyond, document.position(element));
    return table_of({550.0}, {document.number(element, "value")});
}

/// Writes a table of one wavelength, a constant, as its number.
void insert_plain(toml::table& into, const toml::key& key, toml::table spectrum) {
    const toml::array* values = spectrum["value"].as_array();
    if (values != nullptr && values->size() == 1)
        into.insert(key, *(*values)[0].value<double>());
    else
        into.insert(key, std::move(spectrum));
}

[[noreturn]] void refuse_form(const MitsubaObject& owner, const std::string& name,
                              const pugi::xml_node& element, const char* remedy) {
    owner.document().fail(
        element, fmt::format("{} of the {} is a <{}>", name, owner.title(), element.name()),
        remedy);
}

void insert_values(toml::table& into, const char* key, const MitsubaObject& owner,
                   const std::string& name, MitsubaScene& scene, Beyond beyond) {
    const pugi::xml_node element = resolved(owner.find(name), scene);
    const toml::key made = placed_key(key, scene.document().position(element));
    const std::string tag = element.name();
    if (tag == "float")
        into.insert(made, scene.document().number(element, "value"));
    else if (tag == "spectrum")
        insert_plain(into, made, spectrum_of(element, scene, beyond));
    else
        refuse_form(owner, name, element, "write a <spectrum> or a <float>");
}

} // namespace

toml::table mitsuba_emission(const MitsubaObject& owner, const std::string& name,
                             MitsubaScene& scene) {
    const pugi::xml_node found = owner.find(name);
    if (!found)
        return d65(1.0);
    const pugi::xml_node element = resolved(found, scene);
    const std::string tag = element.name();
    if (tag == "float")
        return d65(scene.document().number(element, "value"));
    if (tag == "rgb")
        return rgb_emission(read_rgb(scene.document(), element, "value"));
    if (tag == "spectrum") {
        toml::table spectrum = spectrum_of(element, scene, Beyond::Zero);
        place_keys(spectrum, scene.document().position(element));
        return spectrum;
    }
    refuse_form(owner, name, element, "light has a <spectrum>, an <rgb> or a <float>");
}

void insert_mitsuba_reflectance(toml::table& into, const char* key, const MitsubaObject& owner,
                                const std::string& name, double otherwise, MitsubaScene& scene) {
    const pugi::xml_node found = owner.find(name);
    if (!found) {
        into.insert(key, otherwise);
        return;
    }
    const pugi::xml_node element = resolved(found, scene);
    const toml::key made = placed_key(key, scene.document().position(element));
    const std::string tag = element.name();
    if (tag == "texture") {
        if (std::string(owner.element().name()) == tag)
            refuse_form(owner, name, element, "a texture is made of colours, not of textures");
        into.insert(made, mitsuba_texture(element, scene));
    } else if (tag == "rgb") {
        const Rgb rgb = read_rgb(scene.document(), element, "value");
        into.insert(made, toml::table{{"rgb", toml::array{rgb[0], rgb[1], rgb[2]}}});
    } else {
        insert_values(into, key, owner, name, scene, Beyond::Zero);
    }
}

void insert_mitsuba_spectrum(toml::table& into, const char* key, const MitsubaObject& owner,
                             const std::string& name, MitsubaScene& scene) {
    // The end values are kept: an index of refraction of 0, which Mitsuba takes beyond the samples,
    // leaves no surface to compare with.
    insert_values(into, key, owner, name, scene, Beyond::EndValues);
}

} // namespace reradiant
