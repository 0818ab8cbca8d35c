#include "host/layers/smooth/smooth_stack.h"

#include "kernels/scatter/thin_film.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

FresnelPair fresnel_pair(double n_above, double n_below, double g2_above, double g2_below) {
    if (n_above == n_below)
        return {1.0, 0.0};
    if (g2_above <= 0.0 || g2_below <= 0.0)
        return {0.0, 1.0};
    const double a = std::sqrt(g2_above), b = std::sqrt(g2_below);
    const double u2 = n_above * n_above, l2 = n_below * n_below;
    const double excess = (n_below - n_above) * (n_below + n_above);
    const double s = a + b, p = l2 * a + u2 * b;
    const double rs = excess / (s * s);
    const double rp = excess * (g2_above * (u2 + l2) - u2 * u2) / (p * p);
    const double ts = 4.0 * a * b / (s * s), tp = 4.0 * l2 * a * u2 * b / (p * p);
    return {0.5 * (ts + tp), 0.5 * (rs * rs + rp * rp)};
}

FresnelPair filmed_pair(double n_above, double n_below, double g2_above, double g2_below,
                        const FilmValues& film, double wavelength_nm) {
    if (!(film.thickness_nm > 0.0))
        return fresnel_pair(n_above, n_below, g2_above, g2_below);
    if (g2_above <= 0.0 || g2_below <= 0.0)
        return {0.0, 1.0};
    const double cosine = std::min(std::sqrt(g2_above) / n_above, 1.0);
    const double r = kernels::thin_film_reflectance(cosine, n_above, film.ior, n_below, 0.0,
                                                    film.thickness_nm, wavelength_nm);
    return {1.0 - r, r};
}

SmoothStack smooth_pile(double ior_above, std::span<const StackElement> run) {
    SmoothStack pile{{ior_above}, {0.0}};
    for (const StackElement& element : run) {
        if (const auto* surface = std::get_if<SurfaceValues>(&element)) {
            pile.ior.push_back(surface->ior_below);
            pile.tau.push_back(0.0);
            pile.film.push_back(surface->film);
            pile.wavelength_nm = std::max(pile.wavelength_nm, surface->wavelength_nm);
        } else if (const auto* slab = std::get_if<SlabValues>(&element)) {
            pile.tau.back() = slab->depth();
        }
    }
    return pile;
}

namespace {

/// Optical depth along the path; infinite where the path is evanescent in an absorber.
double slant_depth(double tau, double ior, double g2) {
    if (tau == 0.0)
        return 0.0;
    return g2 > 0.0 ? tau * ior / std::sqrt(g2) : HUGE_VAL;
}

} // namespace

SmoothResponse smooth_response(const SmoothStack& stack, double reference_ior, double cosine) {
    return smooth_response_g2(stack, reference_ior,
                              reference_ior * reference_ior * cosine * cosine);
}

SmoothResponse smooth_response_g2(const SmoothStack& stack, double reference_ior,
                                  double reference_g2) {
    const auto g2_of = [&](std::size_t k) {
        const double n = stack.ior[k];
        return (n - reference_ior) * (n + reference_ior) + reference_g2;
    };
    SmoothResponse response;
    double g2 = g2_of(0);
    for (std::size_t k = 0; k < stack.ior.size(); ++k) {
        // through the slab: 1 - t^2 R' with t = exp(-depth)
        const double depth = slant_depth(stack.tau[k], stack.ior[k], g2);
        const double t = std::exp(-depth);
        const double w = response.loss_up - (1.0 - response.loss_up) * std::expm1(-2.0 * depth);
        response.transmission *= t;
        response.loss_up = w;
        if (k + 1 == stack.ior.size())
            break;
        const double below = g2_of(k + 1);
        const FilmValues film = k < stack.film.size() ? stack.film[k] : FilmValues{};
        const FresnelPair f =
            filmed_pair(stack.ior[k], stack.ior[k + 1], g2, below, film, stack.wavelength_nm);
        // 1 - rf R' with R' = 1 - w, as a sum of positive terms
        const double divisor = f.transmittance + f.reflectance * w;
        if (divisor > 0.0) {
            response.reflection_down +=
                response.transmission * response.transmission * f.reflectance / divisor;
            response.transmission *= f.transmittance / divisor;
            response.loss_up = f.transmittance * w / divisor;
        } else {
            response.transmission = 0.0;
            response.loss_up = 0.0;
        }
        g2 = below;
    }
    return response;
}

} // namespace reradiant
