#pragma once

#include "reradiant/render.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene.h"
#include "tests/support/first_device.h"
#include "tests/support/statistics.h"

namespace reradiant::test {

/// A plane y = 0, seen from above under `view_deg` to its normal by a camera with a narrow angle,
/// so that the view direction hardly varies over the film.
Scene plane_scene(const Material& material, double view_deg, int width, int height,
                  double fov_deg = 0.01);
/// A unit sphere at the origin seen from +z.
Scene sphere_scene(const Material& material, int width, int height);

Light environment(const Spectrum& radiance);
Light directional(double theta_deg, double phi_deg, const Spectrum& irradiance);

Layer layer(double ior, double alpha = 0.0, double tau = 0.0);
/// Lambertian substrate of one reflectance under the given layers.
Material material(std::vector<Layer> layers, double reflectance);
/// A matrix with a Stokes shift on 400-700 nm by 20 nm: excitation around 450, emission around
/// 580 nm, reflectance 0.3, radiant sums below 1.
ReradiationMatrix shifted_matrix();
Material fluorescent(std::vector<Layer> layers, const ReradiationMatrix& matrix);

struct BandStatistics {
    double mean = 0.0, standard_error = 0.0;
};
/// Mean over all pixels of one band, with its standard error from the spread between pixels.
BandStatistics band_statistics(const SpectralImage& image, int band);

} // namespace reradiant::test
