#include "host/layers/stack/stack_check.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>

namespace reradiant {

namespace {

/// NaN is never good.
void check(bool good, const std::string& whose, const char* what, double value,
           const char* remedy) {
    if (!good)
        throw_input_error({}, fmt::format("{} has {} {}", whose, what, value), remedy);
}

void check_film(const FilmValues& film, double wavelength_nm, const std::string& whose) {
    check(film.thickness_nm >= 0.0 && std::isfinite(film.thickness_nm), whose, "film thickness",
          film.thickness_nm, "it must not be negative");
    check(film.ior > 0.0 && std::isfinite(film.ior), whose, "film index of refraction", film.ior,
          "it must be a positive number");
    check(film.thickness_nm == 0.0 || wavelength_nm > 0.0, whose, "a film at wavelength",
          wavelength_nm, "interference needs one in nm");
}

void check_surface(const SurfaceValues& surface, const std::string& whose) {
    check(surface.ior_below > 0.0 && std::isfinite(surface.ior_below), whose, "index of refraction",
          surface.ior_below, "it must be a positive number");
    check(surface.kappa >= 0.0 && std::isfinite(surface.kappa), whose, "kappa", surface.kappa,
          "it must not be negative");
    check(surface.alpha >= 0.0 && surface.alpha <= 1.0, whose, "roughness alpha", surface.alpha,
          "it must be between 0 and 1");
    check_film(surface.film, surface.wavelength_nm, whose);
}

void check_slab(const SlabValues& slab, const std::string& whose) {
    check(slab.tau >= 0.0, whose, "optical depth", slab.tau,
          "absorption and thickness must not be negative");
    check(slab.tau_dyes >= 0.0 && slab.tau_dyes <= slab.tau, whose, "optical depth of dyes",
          slab.tau_dyes, "concentration and absorption must not be negative");
    check(slab.tau_scattering >= 0.0, whose, "scattering depth", slab.tau_scattering,
          "scattering coefficient and thickness must not be negative");
    check(std::fabs(slab.anisotropy) < 1.0, whose, "anisotropy", slab.anisotropy,
          "it must lie between -1 and 1");
}

void check_flakes(const FlakesValues& flakes, const std::string& whose) {
    check(flakes.coverage >= 0.0 && flakes.coverage <= 1.0, whose, "flake coverage",
          flakes.coverage, "it must be between 0 and 1");
    check_surface(flakes.reflector, "the flakes' conductor of " + whose);
}

} // namespace

void check_stack(std::span<const StackElement> stack) {
    int layer = 0;
    for (const StackElement& element : stack) {
        const auto* surface = std::get_if<SurfaceValues>(&element);
        layer += surface && !surface->is_conductor ? 1 : 0;
        const std::string whose = fmt::format("layer {}", layer);
        if (surface)
            check_surface(*surface, surface->is_conductor ? "the conductor" : whose);
        else if (const auto* slab = std::get_if<SlabValues>(&element))
            check_slab(*slab, whose);
        else if (const auto* flakes = std::get_if<FlakesValues>(&element))
            check_flakes(*flakes, whose);
    }
}

} // namespace reradiant
