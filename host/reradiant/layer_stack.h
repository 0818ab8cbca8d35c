#pragma once

#include "reradiant/spectrum.h"

#include <memory>
#include <optional>
#include <vector>

namespace reradiant {

struct ReradiationMatrix;

enum class Distribution { Blinn, Beckmann, Ggx };
enum class Scattering { Multiple, Single };

/// Returns the kernels' number of a distribution, MICROFACET_*.
int kernel_distribution(Distribution distribution);

/// A dielectric film too thin to be a slab: what it reflects is the coherent (Airy) sum over its
/// two faces. It lies on a dielectric interface, on a conductor or on a flake.
struct ThinFilm {
    double thickness_nm = 300.0;
    Spectrum ior = Spectrum::constant(1.5);
};

/// An opaque reflector: complex IOR relative to vacuum, with a surface like an interface's.
struct Conductor {
    Spectrum ior = Spectrum::constant(1.0), kappa; ///< n + i kappa
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0;
    Scattering scattering = Scattering::Multiple;
    std::optional<ThinFilm> film;
};

/// Flakes of metal or coated mica in a slab, after the statistical paints of Ershov et al. 2001:
/// a sheet at the slab's lower end that light meets with probability `coverage` at any angle
/// (flakes lie parallel to the surface but for a tilt whose distribution is the reflector's) and
/// passes straight otherwise. Several layers of the same IOR make flakes at several depths.
struct Flakes {
    double coverage = 0.0; ///< share of the area, 0..1
    Conductor reflector;
};

/// A dye in a slab. Of the power that it absorbs at li it sends out the density Q li e(lo) /
/// (integral over l > li of e(l) l dl) at lo > li, the same in all directions.
struct SlabDye {
    Spectrum absorption;        ///< per unit of thickness at concentration 1, natural logarithm
    double concentration = 1.0; ///< multiplies `absorption`
    Spectrum emission;          ///< e: relative radiant power per nm
    double quantum_yield = 1.0; ///< Q
    /// Instead of emission and yield: what part of the power absorbed in a band is sent out in each
    /// band, within the same band on the diagonal. Column sums are at most 1.
    std::shared_ptr<const ReradiationMatrix> shares;

    bool absorbs() const { return concentration > 0.0 && !absorption.is_zero(); }
};

/// An interface and the slab beneath it.
struct Layer {
    Spectrum ior = Spectrum::constant(1.5); ///< of the medium under the interface
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0; ///< ggx, beckmann: width; blinn: sqrt(2 / (exponent + 2)); 0 is smooth
    Scattering scattering = Scattering::Multiple;
    double thickness = 1.0;
    Spectrum absorption;             ///< per unit of thickness; Beer-Lambert
    Spectrum scattering_coefficient; ///< per unit of thickness; zero: the slab is clear
    double anisotropy = 0.0;         ///< mean cosine g of Henyey and Greenstein 1941
    std::optional<ThinFilm> film;    ///< on this interface
    std::optional<Flakes> flakes;    ///< at the lower end of this slab
    std::vector<SlabDye> dyes = {};

    bool scatters() const { return thickness > 0.0 && !scattering_coefficient.is_zero(); }
    bool is_dyed() const; ///< some dye absorbs light here
};

/// The lower face of a sheet: the interface from its last slab to the air.
struct LowerFace {
    Distribution distribution = Distribution::Ggx;
    double alpha = 0.0; ///< as in Layer
    Scattering scattering = Scattering::Multiple;
};

/// Interfaces and slabs from the air down. Empty: a bare substrate in air.
struct LayerStack {
    std::vector<Layer> layers;
    std::optional<LowerFace> lower_face = {}; ///< of a sheet in air; none: a substrate is beneath

    bool is_sheet() const { return lower_face.has_value(); }
    bool is_smooth() const;     ///< every interface smooth
    bool is_dispersive() const; ///< some IOR depends on wavelength
    bool absorbs() const;
    bool scatters() const; ///< some slab scatters
    bool is_dyed() const;  ///< some slab holds a dye that absorbs
    bool has_films() const;
    bool has_flakes() const;
    /// True when nothing about the stack depends on wavelength.
    bool is_constant() const;
};

/// Returns the width parameter alpha from the half angle b where D falls to D(0)/2: ggx alpha^2 =
/// sin^2 b / (sqrt 2 - cos^2 b); beckmann alpha = tan b / sqrt(ln 2 - 4 ln cos b); blinn exponent =
/// -ln 2 / ln cos b, alpha = sqrt(2 / (exponent + 2)). Returns 0 for 0 degrees.
double alpha_from_roughness_deg(Distribution distribution, double roughness_deg);
/// Returns the Blinn exponent of a width alpha: 2 / alpha^2 - 2.
double blinn_exponent(double alpha);

} // namespace reradiant
