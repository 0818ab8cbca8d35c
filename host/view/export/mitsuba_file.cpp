#include "host/view/export/exchange_files.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

using Rgb = LampColours::Rgb;

std::string rgb(const char* name, const Rgb& colour) {
    return fmt::format("    <rgb name=\"{}\" value=\"{:.6g}, {:.6g}, {:.6g}\"/>\n", name, colour[0],
                       colour[1], colour[2]);
}
std::string number(const char* name, double value) {
    return fmt::format("    <float name=\"{}\" value=\"{:.6g}\"/>\n", name, value);
}

/// A diffuse substrate under its first interface; deeper interfaces are left out, what all slabs
/// absorb on both ways is in the colour.
std::string plastic(const LampColours& colours, std::vector<std::string>& notes) {
    Rgb body = colours.substrate;
    for (const LampColours::Layer& layer : colours.layers)
        for (std::size_t k = 0; k < 3; ++k)
            body[k] *= layer.transmittance[k] * layer.transmittance[k];
    if (colours.layers.size() > 1)
        notes.push_back("Interfaces beneath the first are left out.");
    const Rgb colour = clipped(body, "The body's colour", notes);
    const std::string id = identifier(colours.material);
    if (colours.layers.empty())
        return fmt::format("  <bsdf type=\"diffuse\" id=\"{}\">\n{}  </bsdf>\n", id,
                           rgb("reflectance", colour));
    const LampColours::Layer& coat = colours.layers.front();
    const bool is_rough = coat.alpha > 0.0;
    std::string text =
        fmt::format("  <bsdf type=\"{}\" id=\"{}\">\n", is_rough ? "roughplastic" : "plastic", id);
    text += rgb("diffuse_reflectance", colour) + number("int_ior", coat.ior) +
            "    <boolean name=\"nonlinear\" value=\"true\"/>\n";
    if (is_rough)
        text += number("alpha", coat.alpha) +
                fmt::format("    <string name=\"distribution\" value=\"{}\"/>\n",
                            coat.distribution == Distribution::Ggx ? "ggx" : "beckmann");
    return text + "  </bsdf>\n";
}

std::string metal(const LampColours& colours, std::vector<std::string>& notes) {
    Rgb base = colours.substrate;
    for (const LampColours::Layer& layer : colours.layers)
        for (std::size_t k = 0; k < 3; ++k)
            base[k] *= layer.transmittance[k] * layer.transmittance[k];
    std::string text =
        fmt::format("  <bsdf type=\"principled\" id=\"{}\">\n", identifier(colours.material));
    text += rgb("base_color", clipped(base, "The metal's colour", notes)) +
            number("metallic", 1.0) + number("roughness", std::sqrt(colours.metal_alpha));
    if (!colours.layers.empty()) {
        text += number("clearcoat", 1.0) +
                number("clearcoat_gloss", 1.0 - std::sqrt(colours.layers.front().alpha));
        notes.push_back("The clear coat of `principled` has an index of 1.5 and a quarter of a "
                        "coat's weight.");
    }
    return text + "  </bsdf>\n";
}

} // namespace

std::string mitsuba_file(const LampColours& colours) {
    LampColours said = colours;
    if (colours.sigma > 0.0)
        said.left_out.push_back("The substrate is Lambertian instead of Oren and Nayar's.");
    const std::string bsdf =
        colours.is_metal ? metal(colours, said.left_out) : plastic(colours, said.left_out);
    return "<!--\n" +
           exchange_head(said, "the nearest BSDF of Mitsuba 3; light the scene with a white lamp",
                         " ") +
           "-->\n<scene version=\"3.0.0\">\n" + bsdf + "</scene>\n";
}

} // namespace reradiant
