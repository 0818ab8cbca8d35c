#include "reradiant/stack_elements.h"

#include <algorithm>

namespace reradiant {

namespace {

FilmValues film_at(const std::optional<ThinFilm>& film, double wavelength_nm) {
    return film ? FilmValues{film->thickness_nm, film->ior(wavelength_nm)} : FilmValues{};
}

SurfaceValues interface_at(const Layer& layer, double wavelength_nm, double ior_above) {
    return {.ior_above = ior_above,
            .ior_below = layer.ior(wavelength_nm),
            .distribution = layer.distribution,
            .alpha = layer.alpha,
            .scattering = layer.scattering,
            .film = film_at(layer.film, wavelength_nm),
            .wavelength_nm = layer.film ? wavelength_nm : 0.0};
}

SlabValues slab_at(const Layer& layer, double wavelength_nm, double ior) {
    double dyes = 0.0;
    for (const SlabDye& dye : layer.dyes)
        dyes += dye.concentration * dye.absorption(wavelength_nm) * layer.thickness;
    return {.ior = ior,
            .tau = layer.absorption(wavelength_nm) * layer.thickness + dyes,
            .tau_scattering = layer.scattering_coefficient(wavelength_nm) * layer.thickness,
            .anisotropy = layer.anisotropy,
            .may_scatter = layer.scatters(),
            .tau_dyes = dyes};
}

SurfaceValues lower_face_at(const LowerFace& face, double ior_above) {
    return {.ior_above = ior_above,
            .ior_below = 1.0,
            .distribution = face.distribution,
            .alpha = face.alpha,
            .scattering = face.scattering};
}

bool is_substrate(const StackElement& element) {
    const auto* surface = std::get_if<SurfaceValues>(&element);
    return surface ? surface->is_conductor : std::holds_alternative<DiffuseValues>(element);
}

} // namespace

bool SurfaceValues::scatters() const {
    const double ratio = std::max(ior_above, ior_below) / std::min(ior_above, ior_below);
    return alpha > 0.0 && (is_conductor || ratio - 1.0 > 5e-5);
}

StackElements stack_at(const LayerStack& stack, double wavelength_nm) {
    StackElements elements;
    double ior = 1.0;
    for (const Layer& layer : stack.layers) {
        const SurfaceValues interface = interface_at(layer, wavelength_nm, ior);
        ior = interface.ior_below;
        elements.push_back(interface);
        elements.push_back(slab_at(layer, wavelength_nm, ior));
        // a coverage that is not a number is for check_stack to refuse
        if (layer.flakes && layer.flakes->coverage != 0.0)
            elements.push_back(FlakesValues{
                layer.flakes->coverage, conductor_at(layer.flakes->reflector, wavelength_nm, ior)});
    }
    if (stack.lower_face)
        elements.push_back(lower_face_at(*stack.lower_face, ior));
    return elements;
}

SurfaceValues conductor_at(const Conductor& conductor, double wavelength_nm, double ior_above) {
    return {ior_above,
            conductor.ior(wavelength_nm),
            conductor.kappa(wavelength_nm),
            true,
            conductor.distribution,
            conductor.alpha,
            conductor.scattering,
            film_at(conductor.film, wavelength_nm),
            conductor.film ? wavelength_nm : 0.0};
}

StackElements stack_over(StackElements stack, StackElement substrate) {
    const double ior = lowest_ior(stack);
    if (auto* conductor = std::get_if<SurfaceValues>(&substrate))
        conductor->ior_above = ior;
    else
        std::get<DiffuseValues>(substrate).ior_above = ior;
    stack.push_back(substrate);
    return stack;
}

const SurfaceValues* surface_of(const StackElement& element) {
    if (const auto* flakes = std::get_if<FlakesValues>(&element))
        return &flakes->reflector;
    return std::get_if<SurfaceValues>(&element);
}

std::vector<std::size_t> reflecting_elements(std::span<const StackElement> stack) {
    std::vector<std::size_t> elements;
    for (std::size_t e = 0; e < stack.size(); ++e)
        if (surface_of(stack[e]))
            elements.push_back(e);
    return elements;
}

double coverage_of(const StackElement& element) {
    const auto* flakes = std::get_if<FlakesValues>(&element);
    return flakes ? flakes->coverage : 1.0;
}

bool scatters(const StackElement& element) {
    if (const auto* slab = std::get_if<SlabValues>(&element))
        return slab->scatters();
    const SurfaceValues* surface = surface_of(element);
    return surface && surface->scatters();
}

const SurfaceValues* conductor_of(std::span<const StackElement> stack) {
    return !stack.empty() && is_substrate(stack.back()) ? surface_of(stack.back()) : nullptr;
}

std::span<const StackElement> above_substrate(std::span<const StackElement> stack) {
    const bool has_substrate = !stack.empty() && is_substrate(stack.back());
    return stack.first(stack.size() - (has_substrate ? 1 : 0));
}

double lowest_ior(std::span<const StackElement> stack) {
    const std::span<const StackElement> above = above_substrate(stack);
    if (above.empty())
        return 1.0;
    if (const auto* slab = std::get_if<SlabValues>(&above.back()))
        return slab->ior;
    const SurfaceValues& surface = *surface_of(above.back());
    return surface.is_conductor ? surface.ior_above : surface.ior_below;
}

} // namespace reradiant
