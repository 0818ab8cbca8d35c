#include "host/view/export/exchange_files.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

using Rgb = LampColours::Rgb;

std::string input(const char* name, double value) {
    return fmt::format("    <input name=\"{}\" type=\"float\" value=\"{:.6g}\"/>\n", name, value);
}
std::string input(const char* name, const Rgb& value) {
    return fmt::format("    <input name=\"{}\" type=\"color3\" value=\"{:.6g}, {:.6g}, {:.6g}\" "
                       "colorspace=\"lin_rec709\"/>\n",
                       name, value[0], value[1], value[2]);
}

/// OpenPBR's roughness, whose square is the width alpha.
double roughness(double alpha) {
    return std::sqrt(alpha);
}

Rgb product(const Rgb& a, const Rgb& b) {
    return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

/// The interface above the base is OpenPBR's specular one over a diffuse base, and its coat over a
/// metal or above another layer.
std::string inputs(const LampColours& colours, std::vector<std::string>& notes) {
    const std::size_t coats = colours.layers.size();
    const bool has_specular = !colours.is_metal && coats > 0;
    const bool has_coat = coats > (has_specular ? 1u : 0u);
    Rgb base = colours.substrate;
    // what a diffuse base's own layer absorbs, both ways, goes into its colour
    if (has_specular)
        base = product(base, product(colours.layers.back().transmittance,
                                     colours.layers.back().transmittance));
    std::string text = input("base_color", clipped(base, "The base's colour", notes));
    text += input("base_metalness", colours.is_metal ? 1.0 : 0.0);
    if (colours.sigma > 0.0)
        text +=
            input("base_diffuse_roughness", std::min(colours.sigma * 2.0 / std::numbers::pi, 1.0));
    text += input("specular_weight", colours.is_metal || has_specular ? 1.0 : 0.0);
    if (has_specular)
        text += input("specular_ior", colours.layers.back().ior /
                                          (coats > 1 ? colours.layers[coats - 2].ior : 1.0));
    if (colours.is_metal || has_specular)
        text += input("specular_roughness",
                      roughness(has_specular ? colours.layers.back().alpha : colours.metal_alpha));
    if (!has_coat)
        return text;
    const LampColours::Layer& coat = colours.layers.front();
    if (coats > (has_specular ? 2u : 1u))
        notes.push_back("OpenPBR has one coat: the layers between the first and the base are left "
                        "out.");
    return text + input("coat_weight", 1.0) +
           input("coat_color", clipped(product(coat.transmittance, coat.transmittance),
                                       "The coat's colour", notes)) +
           input("coat_ior", coat.ior) + input("coat_roughness", roughness(coat.alpha));
}

/// Text inside an XML attribute or comment.
std::string comment_of(const LampColours& said) {
    return "<!--\n" + exchange_head(said, "the nearest OpenPBR surface", " ") + "-->\n";
}

} // namespace

std::string materialx_file(const LampColours& colours) {
    LampColours said = colours;
    const std::string all = inputs(colours, said.left_out);
    said.left_out.push_back("Facets are GGX's, whatever the layers' distributions.");
    const std::string name = identifier(colours.material);
    return fmt::format("<?xml version=\"1.0\"?>\n{0}<materialx version=\"1.39\" "
                       "colorspace=\"lin_rec709\">\n"
                       "  <open_pbr_surface name=\"{1}_surface\" type=\"surfaceshader\">\n{2}"
                       "  </open_pbr_surface>\n"
                       "  <surfacematerial name=\"{1}\" type=\"material\">\n"
                       "    <input name=\"surfaceshader\" type=\"surfaceshader\" "
                       "nodename=\"{1}_surface\"/>\n"
                       "  </surfacematerial>\n</materialx>\n",
                       comment_of(said), name, all);
}

} // namespace reradiant
