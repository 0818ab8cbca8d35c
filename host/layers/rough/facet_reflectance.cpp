#include "host/layers/rough/facet_reflectance.h"

#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/thin_film.h"

namespace reradiant {

double facet_reflectance(const SurfaceValues& surface, double cos_theta) {
    if (!surface.is_conductor && !surface.has_film()) // the same number, in less time
        return kernels::fresnel_dielectric(cos_theta, surface.ior_below / surface.ior_above);
    // without a film this is Fresnel's bare conductor, whatever the wavelength
    return kernels::thin_film_reflectance(cos_theta, surface.ior_above, surface.film.ior,
                                          surface.ior_below, surface.kappa,
                                          surface.film.thickness_nm, surface.wavelength_nm);
}

} // namespace reradiant
