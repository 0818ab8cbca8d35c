#include "host/layers/stack/lobe_quadrature.h"

#include "host/layers/stack/directions.h"
#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

using kernels::Vec3;

namespace {

constexpr int ring_nodes = 16, azimuth_nodes = 24;

/// Azimuth from that of wi below which half vectors of polar angle theta send wo above the surface.
double largest_azimuth(const Vec3& wi, double theta) {
    const double ch = std::cos(theta), sh = std::sin(theta);
    const double si = std::sqrt(wi.x * wi.x + wi.y * wi.y);
    // wo.z = 2 (wi.h) ch - wi.z > 0
    const double rest = 0.5 * wi.z / ch - wi.z * ch;
    return std::acos(std::clamp(rest / std::max(si * sh, 1e-300), -1.0, 1.0));
}

/// One ring of half vectors, per polar angle.
double ring(const Vec3& wi, double theta, const std::function<double(const Vec3&)>& f) {
    const double reach = largest_azimuth(wi, theta);
    const Quadrature& rule = gauss_legendre(azimuth_nodes);
    const double azimuth_i = std::atan2(wi.y, wi.x);
    double sum = 0.0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const Vec3 h = direction_at(std::cos(theta), azimuth_i + reach * rule.nodes[k]);
        const double cos_h = kernels::vec3_dot(wi, h);
        const Vec3 wo = kernels::vec3_sub(kernels::vec3_scale(h, 2.0 * cos_h), wi);
        if (cos_h > 0.0 && wo.z > 0.0)
            sum += rule.weights[k] * 4.0 * cos_h * wo.z * f(wo);
    }
    return 2.0 * reach * std::sin(theta) * sum;
}

} // namespace

double integrate_about_mirror(const Vec3& wi, const std::function<double(const Vec3& wo)>& f) {
    const double theta_i = std::acos(std::clamp(wi.z, -1.0, 1.0));
    const double whole = 0.5 * (0.5 * std::numbers::pi - theta_i); // all azimuths up to here
    const double last = 0.5 * (0.5 * std::numbers::pi + theta_i);  // none beyond
    double sum = 0.0;
    const auto piece = [&](double from, double to) {
        sum +=
            integrate_sin2(from, to, ring_nodes, [&](double theta) { return ring(wi, theta, f); });
    };
    double high = whole;
    for (; high > 1e-6; high *= 0.5)
        piece(0.5 * high, high);
    piece(0.0, high);
    // a lobe wider than `whole` (light at grazing angles) goes on beyond it
    for (double low = whole; low < last;) {
        const double next = std::min(last, std::max(2.0 * low, 1e-6));
        piece(low, next);
        low = next;
    }
    return sum;
}

} // namespace reradiant
