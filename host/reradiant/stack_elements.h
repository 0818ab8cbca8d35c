#pragma once

#include "reradiant/layer_stack.h"

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace reradiant {

/// A thin film at one wavelength.
struct FilmValues {
    double thickness_nm = 0.0; ///< 0: no film
    double ior = 1.0;

    bool operator==(const FilmValues&) const = default;
};

/// A surface at one wavelength: an interface between two media, or a conductor in one medium.
struct SurfaceValues {
    double ior_above = 1.0; ///< of a flake also that of the medium beneath it
    double ior_below = 1.5; ///< of a conductor its own; all relative to vacuum
    double kappa = 0.0;     ///< of a conductor
    bool is_conductor = false;
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0; ///< width of the microsurface as in Layer; 0: smooth
    Scattering scattering = Scattering::Multiple;
    FilmValues film = {};
    double wavelength_nm = 0.0; ///< for the interference in the film; 0 without one

    bool has_film() const { return film.thickness_nm > 0.0; }
    /// True when the surface spreads light: it has a width, and the media of an interface differ by
    /// more than the operators of rough interfaces resolve (5e-5 of IOR; below that an interface
    /// neither reflects nor deflects visibly).
    bool scatters() const;
    bool operator==(const SurfaceValues&) const = default;
};

/// A slab at one wavelength: the medium between two surfaces. Depths are those of normal passage.
struct SlabValues {
    double ior = 1.5;
    double tau = 0.0;            ///< optical depth of absorption, by dyes and all else
    double tau_scattering = 0.0; ///< optical depth of scattering
    double anisotropy = 0.0;     ///< mean cosine g of Henyey and Greenstein 1941
    bool may_scatter = false;    ///< at some wavelength, if not at this one
    double tau_dyes = 0.0;       ///< part of `tau` by dyes, which may send it out again

    double depth() const { return tau + tau_scattering; }
    bool scatters() const { return tau_scattering > 0.0; }
    bool operator==(const SlabValues&) const = default;
};

/// A sheet of flakes that light meets with probability `coverage`.
struct FlakesValues {
    double coverage = 0.0;
    SurfaceValues reflector;

    bool operator==(const FlakesValues&) const = default;
};

/// A diffuse substrate. What it sends back couples wavelengths, so its matrix stands elsewhere
/// (host/layers/stack/substrate_values.h).
struct DiffuseValues {
    double ior_above = 1.0;
    double sigma = 0.0; ///< Oren-Nayar, radians; 0: Lambertian

    bool operator==(const DiffuseValues&) const = default;
};

/// One thing that light meets on its way down.
using StackElement = std::variant<SurfaceValues, SlabValues, FlakesValues, DiffuseValues>;

/// A stack at one wavelength as every model reads it: elements from the air down. Each interface is
/// followed by the slab beneath it and that by the slab's flakes, if it has any; which elements
/// there are does not depend on wavelength. The list may end in a substrate, which is a diffuse one
/// or a conductor; without one it is the stack alone, and a sheet ends in its lower face, an
/// interface to the air. What dyes send out couples wavelengths, like a substrate's matrix; it
/// stands elsewhere (host/layers/stack/slab_emission.h).
using StackElements = std::vector<StackElement>;

/// Returns the stack at a wavelength, without a substrate.
StackElements stack_at(const LayerStack& stack, double wavelength_nm);
/// Returns a conductor in a medium of IOR `ior_above` at a wavelength.
SurfaceValues conductor_at(const Conductor& conductor, double wavelength_nm,
                           double ior_above = 1.0);
/// Returns the stack with a substrate at its end, whose `ior_above` is that of the stack's lower
/// end, whatever it was.
StackElements stack_over(StackElements stack, StackElement substrate);

/// Returns the surface of an interface, of flakes or of a conductor; null for a slab and for a
/// diffuse substrate.
const SurfaceValues* surface_of(const StackElement& element);
/// Returns the indices of the elements that have a surface, from the air down.
std::vector<std::size_t> reflecting_elements(std::span<const StackElement> stack);
/// Returns the share of the light that meets the element: the coverage of flakes, else 1.
double coverage_of(const StackElement& element);
/// True for what spreads light beneath the air: a surface or a slab that scatters at this
/// wavelength.
bool scatters(const StackElement& element);
/// Returns the conductor that the stack stands on; null where there is none.
const SurfaceValues* conductor_of(std::span<const StackElement> stack);
/// Returns the elements above the substrate.
std::span<const StackElement> above_substrate(std::span<const StackElement> stack);
/// Returns the IOR of the medium above the substrate, or at the lower end of a stack without one;
/// 1 where there are no layers.
double lowest_ior(std::span<const StackElement> stack);

} // namespace reradiant
