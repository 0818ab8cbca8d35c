#include "host/layers/rough/facet_reflectance.h"

#include "kernels/scatter/fresnel.h"
#include "kernels/scatter/thin_film.h"

namespace reradiant {

double facet_reflectance(const LayerValues& layer, double ior_above, double cos_theta) {
    if (layer.film.thickness_nm > 0.0) {
        return kernels::thin_film_reflectance(cos_theta, ior_above, layer.film.ior, layer.ior, 0.0,
                                              layer.film.thickness_nm, layer.wavelength_nm);
    }
    return kernels::fresnel_dielectric(cos_theta, layer.ior / ior_above);
}

double facet_reflectance(const ConductorValues& conductor, double ior_above, double cos_theta) {
    // without a film this is Fresnel's bare conductor, whatever the wavelength
    return kernels::thin_film_reflectance(cos_theta, ior_above, conductor.film.ior, conductor.ior,
                                          conductor.kappa, conductor.film.thickness_nm,
                                          conductor.wavelength_nm);
}

} // namespace reradiant
