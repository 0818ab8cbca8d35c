#include "host/view/export/exchange_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Rgb = LampColours::Rgb;

const char* distribution_name(Distribution distribution) {
    return distribution == Distribution::Ggx ? "ggx" : "beckmann";
}

std::string colour_text(const Rgb& colour) {
    return fmt::format("color({:.6g}, {:.6g}, {:.6g})", colour[0], colour[1], colour[2]);
}

constexpr const char* functions = R"osl(
// Reflectance of a smooth dielectric interface; c is the cosine above it, eta = n below / n above.
float rr_fresnel(float c, float eta) {
    float g2 = eta * eta - 1 + c * c;
    if (g2 <= 0)
        return eta == 1 ? 0.0 : 1.0;
    float g = sqrt(g2);
    float s = (c - g) / (c + g);
    float p = (eta * eta * c - g) / (eta * eta * c + g);
    return 0.5 * (s * s + p * p);
}
// Share of diffuse light that passes the interface.
float rr_mean_passed(float eta) {
    float sum = 0;
    for (int k = 0; k < 32; k += 1) {
        float c = (k + 0.5) / 32.0;
        sum += 2 * c * (1 - rr_fresnel(c, eta)) / 32.0;
    }
    return sum;
}
)osl";

/// Mean length of the way through a slab of depth 1, over diffuse light from air.
double mean_path(double ior) {
    const double excess = (ior - 1.0) * (ior + 1.0);
    double sum = 0.0;
    for (int k = 0; k < 64; ++k) {
        const double c = (k + 0.5) / 64.0;
        sum += 2.0 * c / 64.0 * ior / std::sqrt(std::max(excess + c * c, 1e-6));
    }
    return sum;
}

std::string layer_text(const LampColours::Layer& layer, double ior_above, std::size_t index) {
    const double eta = layer.ior / ior_above;
    std::string text = fmt::format("\n    // Layer {}, from the air down\n", index + 1);
    text +=
        fmt::format("    reflected = closure_has_fresnel ? 1.0 : rr_fresnel(c, {:.6g});\n", eta);
    text += fmt::format("    Out += through_out * through_in * reflected *\n"
                        "           microfacet(\"{}\", Nn, along, max({:.6g}, 0.001), "
                        "max({:.6g}, 0.001), {:.6g}, 0);\n",
                        distribution_name(layer.distribution), layer.alpha, layer.alpha, eta);
    text += fmt::format("    through_out *= 1 - rr_fresnel(c, {0:.6g});\n"
                        "    through_in *= rr_mean_passed({0:.6g});\n",
                        eta);
    text += fmt::format("    c = sqrt(max({0:.6g} + c * c, 0)) / {1:.6g};\n", eta * eta - 1.0, eta);
    text += fmt::format("    through_out *= pow({0}, 1 / max(c, 0.001));\n"
                        "    through_in *= pow({0}, {1:.6g});\n",
                        colour_text(layer.transmittance), mean_path(layer.ior));
    return text;
}

std::string substrate_text(const LampColours& colours, double ior_above) {
    if (colours.is_metal)
        return fmt::format("\n    // The metal, whose colour is that along the normal\n"
                           "    Out += through_out * through_in * {} *\n"
                           "           microfacet(\"ggx\", Nn, along, max({:.6g}, 0.001), "
                           "max({:.6g}, 0.001), {:.6g}, 0);\n",
                           colour_text(colours.substrate), colours.metal_alpha, colours.metal_alpha,
                           1e6 * ior_above);
    if (colours.sigma > 0.0)
        return fmt::format("\n    // The substrate\n"
                           "    Out += through_out * through_in * {} * oren_nayar(Nn, {:.6g});\n",
                           colour_text(colours.substrate), colours.sigma);
    return fmt::format("\n    // The substrate\n"
                       "    Out += through_out * through_in * {} * diffuse(Nn);\n",
                       colour_text(colours.substrate));
}

} // namespace

std::string osl_file(const LampColours& colours) {
    LampColours said = colours;
    said.left_out.push_back("Light between the layers is left out, as in the model; what comes in "
                            "passes with its mean over directions, since closures do not know "
                            "where light comes from.");
    said.left_out.push_back("Blinn's distribution stands as Beckmann's of the same width.");
    std::string text =
        exchange_head(said, "the nested model of Weidlich and Wilkie (2007) as closures", "//");
    text += functions;
    text += fmt::format(
        "\nshader {}(\n    normal Nn = N,\n"
        "    int closure_has_fresnel = 1 [[ string help = \"0 where the renderer's microfacet "
        "closure leaves out Fresnel's reflectance\" ]],\n"
        "    output closure color Out = 0)\n{{\n"
        "    float c = abs(dot(Nn, I));\n    float reflected = 1;\n"
        "    vector along = normalize(cross(Nn, abs(Nn[2]) < 0.9 ? vector(0, 0, 1) : vector(1, 0, "
        "0)));\n"
        "    color through_in = 1, through_out = 1;\n",
        identifier(colours.material));
    double ior = 1.0;
    for (std::size_t k = 0; k < colours.layers.size(); ++k) {
        text += layer_text(colours.layers[k], ior, k);
        ior = colours.layers[k].ior;
    }
    return text + substrate_text(colours, ior) + "}\n";
}

} // namespace reradiant
