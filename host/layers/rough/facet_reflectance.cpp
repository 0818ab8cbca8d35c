#include "host/layers/rough/facet_reflectance.h"

#include "kernels/scatter/thin_film.h"

namespace reradiant {

double facet_reflectance(const SurfaceValues& surface, double cos_theta) {
    // without a film this is Fresnel's bare interface or conductor, whatever the wavelength
    return kernels::thin_film_reflectance(cos_theta, surface.ior_above, surface.film.ior,
                                          surface.ior_below, surface.kappa,
                                          surface.film.thickness_nm, surface.wavelength_nm);
}

} // namespace reradiant
