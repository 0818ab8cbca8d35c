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

void check_alpha(double alpha, const std::string& whose) {
    check(alpha >= 0.0 && alpha <= 1.0, whose, "roughness alpha", alpha,
          "it must be between 0 and 1");
}

void check_film(const FilmValues& film, double wavelength_nm, const std::string& whose) {
    check(film.thickness_nm >= 0.0 && std::isfinite(film.thickness_nm), whose, "film thickness",
          film.thickness_nm, "it must not be negative");
    check(film.ior > 0.0 && std::isfinite(film.ior), whose, "film index of refraction", film.ior,
          "it must be a positive number");
    check(film.thickness_nm == 0.0 || wavelength_nm > 0.0, whose, "a film at wavelength",
          wavelength_nm, "interference needs one in nm");
}

void check_reflector(const ConductorValues& conductor, const std::string& whose) {
    check(conductor.ior > 0.0 && std::isfinite(conductor.ior), whose, "index of refraction",
          conductor.ior, "it must be a positive number");
    check(conductor.kappa >= 0.0 && std::isfinite(conductor.kappa), whose, "kappa", conductor.kappa,
          "it must not be negative");
    check_alpha(conductor.alpha, whose);
    check_film(conductor.film, conductor.wavelength_nm, whose);
}

void check_layer(const LayerValues& layer, const std::string& whose) {
    check(layer.ior > 0.0 && std::isfinite(layer.ior), whose, "index of refraction", layer.ior,
          "it must be a positive number");
    check_alpha(layer.alpha, whose);
    check(layer.tau >= 0.0, whose, "optical depth", layer.tau,
          "absorption and thickness must not be negative");
    check(layer.tau_scattering >= 0.0, whose, "scattering depth", layer.tau_scattering,
          "scattering coefficient and thickness must not be negative");
    check(std::fabs(layer.anisotropy) < 1.0, whose, "anisotropy", layer.anisotropy,
          "it must lie between -1 and 1");
    check_film(layer.film, layer.wavelength_nm, whose);
    check(layer.flake_coverage >= 0.0 && layer.flake_coverage <= 1.0, whose, "flake coverage",
          layer.flake_coverage, "it must be between 0 and 1");
    if (layer.flake_coverage > 0.0)
        check_reflector(layer.flakes, "the flakes' conductor of " + whose);
}

} // namespace

void check_stack(const StackValues& stack) {
    for (std::size_t k = 0; k < stack.size(); ++k)
        check_layer(stack[k], fmt::format("layer {}", k + 1));
}

void check_conductor(const ConductorValues& conductor) {
    check_reflector(conductor, "the conductor");
}

} // namespace reradiant
