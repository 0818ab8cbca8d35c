#include "reradiant/layer_stack.h"

#include "kernels/scatter/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

int kernel_distribution(Distribution distribution) {
    switch (distribution) {
    case Distribution::Blinn:
        return MICROFACET_BLINN;
    case Distribution::Beckmann:
        return MICROFACET_BECKMANN;
    case Distribution::Ggx:
        break;
    }
    return MICROFACET_GGX;
}

bool Layer::is_dyed() const {
    return thickness > 0.0 && std::ranges::any_of(dyes, &SlabDye::absorbs);
}

bool LayerStack::is_smooth() const {
    return std::all_of(layers.begin(), layers.end(),
                       [](const Layer& l) { return l.alpha == 0.0; }) &&
           !(lower_face && lower_face->alpha > 0.0);
}

bool LayerStack::is_dispersive() const {
    return std::any_of(layers.begin(), layers.end(),
                       [](const Layer& l) { return !l.ior.is_constant(); });
}

bool LayerStack::absorbs() const {
    return std::any_of(layers.begin(), layers.end(), [](const Layer& l) {
        return l.is_dyed() || (l.thickness > 0.0 && !l.absorption.is_zero());
    });
}

bool LayerStack::scatters() const {
    return std::any_of(layers.begin(), layers.end(), [](const Layer& l) { return l.scatters(); });
}

bool LayerStack::is_dyed() const {
    return std::ranges::any_of(layers, &Layer::is_dyed);
}

bool LayerStack::has_films() const {
    return std::any_of(layers.begin(), layers.end(),
                       [](const Layer& l) { return l.film.has_value(); });
}

bool LayerStack::has_flakes() const {
    return std::any_of(layers.begin(), layers.end(),
                       [](const Layer& l) { return l.flakes.has_value(); });
}

bool LayerStack::is_constant() const {
    return std::all_of(layers.begin(), layers.end(), [](const Layer& l) {
        return l.ior.is_constant() && l.absorption.is_constant() &&
               l.scattering_coefficient.is_constant() && !l.film && !l.flakes && !l.is_dyed();
    });
}

double alpha_from_roughness_deg(Distribution distribution, double roughness_deg) {
    if (roughness_deg == 0.0)
        return 0.0;
    const double beta = roughness_deg * std::numbers::pi / 180.0;
    const double sin_beta = std::sin(beta);
    // ln cos by log1p: at 0.01 degrees cos differs from 1 by 1.5e-8 only
    const double log_cos = 0.5 * std::log1p(-sin_beta * sin_beta);
    const double ln2 = std::numbers::ln2;
    switch (distribution) {
    case Distribution::Ggx: {
        const double s2 = sin_beta * sin_beta;
        return std::sqrt(s2 / (std::numbers::sqrt2 - 1.0 + s2));
    }
    case Distribution::Beckmann:
        return std::tan(beta) / std::sqrt(ln2 - 4.0 * log_cos);
    case Distribution::Blinn:
        break;
    }
    return std::sqrt(2.0 / (2.0 - ln2 / log_cos));
}

double blinn_exponent(double alpha) {
    return 2.0 / (alpha * alpha) - 2.0;
}

} // namespace reradiant
