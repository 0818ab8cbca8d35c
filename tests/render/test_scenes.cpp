#include "tests/render/test_scenes.h"

#include "tests/support/directions.h"

#include <cmath>
#include <numbers>

namespace reradiant::test {

Scene plane_scene(const Material& material, double view_deg, int width, int height,
                  double fov_deg) {
    Scene scene;
    scene.film.width = width;
    scene.film.height = height;
    scene.camera.origin = {10.0 * std::sin(radians(view_deg)), 10.0 * std::cos(radians(view_deg)),
                           0.0};
    scene.camera.target = {0.0, 0.0, 0.0};
    scene.camera.up = {0.0, 0.0, 1.0};
    scene.camera.fov_deg = fov_deg;
    scene.materials = {material};
    scene.shapes = {{RectangleShape{{0, 0, 0}, {0, 0, 1000}, {1000, 0, 0}}, 0}};
    return scene;
}

Scene sphere_scene(const Material& material, int width, int height) {
    Scene scene;
    scene.film.width = width;
    scene.film.height = height;
    scene.camera.origin = {0, 0, 5};
    scene.camera.fov_deg = 20;
    scene.materials = {material};
    scene.shapes = {{SphereShape{{0, 0, 0}, 1.0}, 0}};
    return scene;
}

Light environment(const Spectrum& radiance) {
    return EnvironmentLight{radiance};
}

Light directional(double theta_deg, double phi_deg, const Spectrum& irradiance) {
    const double s = std::sin(radians(theta_deg));
    return DirectionalLight{{-s * std::cos(radians(phi_deg)), -std::cos(radians(theta_deg)),
                             -s * std::sin(radians(phi_deg))},
                            irradiance};
}

Layer layer(double ior, double alpha, double tau) {
    Layer result;
    result.ior = Spectrum::constant(ior);
    result.alpha = alpha;
    result.absorption = Spectrum::constant(tau);
    return result;
}

Material material(std::vector<Layer> layers, double reflectance) {
    Material result;
    result.name = "test";
    result.stack.layers = std::move(layers);
    result.substrate.reflectance = Spectrum::constant(reflectance);
    return result;
}

ReradiationMatrix shifted_matrix() {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = grid_from_range(400, 700, 20);
    const int n = matrix.emission.count;
    matrix.values = Eigen::MatrixXd::Zero(n, n);
    const auto bell = [](double x, double centre, double width) {
        return std::exp(-0.5 * (x - centre) * (x - centre) / (width * width));
    };
    for (int i = 0; i < n; ++i) {
        for (int o = i + 1; o < n; ++o)
            matrix.values(o, i) = 0.12 * bell(matrix.emission.centre_nm(o), 580, 30) *
                                  bell(matrix.excitation.centre_nm(i), 450, 40);
        matrix.values(i, i) = 0.3;
    }
    return matrix;
}

Material fluorescent(std::vector<Layer> layers, const ReradiationMatrix& matrix) {
    Material result = material(std::move(layers), 0.0);
    result.substrate.reflectance = matrix.reflectance();
    result.substrate.matrix = std::make_shared<const ReradiationMatrix>(matrix);
    return result;
}

BandStatistics band_statistics(const SpectralImage& image, int band) {
    const double n = static_cast<double>(image.width) * image.height;
    double sum = 0.0, squares = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            sum += static_cast<double>(image.at(x, y, band));
    const double mean = sum / n;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double d = static_cast<double>(image.at(x, y, band)) - mean;
            squares += d * d;
        }
    return {mean, std::sqrt(squares / (n * (n - 1.0)))};
}

} // namespace reradiant::test
