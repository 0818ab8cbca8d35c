#pragma once

#include "kernels/scatter/microfacet.h"
#include "tests/layers/layer_values.h"

#include <cmath>
#include <random>

/// A slow, obvious random walk through a stack, written on its own: explicit heights, explicit
/// Bernoulli choices, one photon at a time, nothing shared with the code under test but the
/// definitions of the model.
namespace reradiant::reference {

struct Vector {
    double x, y, z;
};
inline Vector operator*(double s, const Vector& v) {
    return {s * v.x, s * v.y, s * v.z};
}
inline Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline double dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector unit(const Vector& v) {
    return (1.0 / std::sqrt(dot(v, v))) * v;
}
inline Vector upside_down(const Vector& v) {
    return {v.x, v.y, -v.z};
}

/// Unpolarised Fresnel reflectance by its textbook form.
inline double fresnel(double cos_i, double n_i, double n_t) {
    const double sin_t = n_i / n_t * std::sqrt(std::fmax(1.0 - cos_i * cos_i, 0.0));
    if (sin_t >= 1.0)
        return 1.0;
    const double cos_t = std::sqrt(1.0 - sin_t * sin_t);
    const double s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t);
    const double p = (n_t * cos_i - n_i * cos_t) / (n_t * cos_i + n_i * cos_t);
    return 0.5 * (s * s + p * p);
}

class Walker {
public:
    explicit Walker(unsigned seed) : generator_(seed) {}

    double uniform() { return distribution_(generator_); }

    enum class End { Air, Substrate, Absorbed, Lost };
    struct Result {
        End end;
        double cosine;    ///< at which it left, if it did
        Vector direction; ///< in which it travelled there
    };

    /// One photon: from the air with cosine c, or emitted by the (black) substrate.
    Result from_air(const StackValues& stack, double c) {
        return travel(stack, 0, {std::sqrt(1.0 - c * c), 0.0, -c});
    }
    Result from_substrate(const StackValues& stack) {
        const double c = std::sqrt(uniform());
        return from_below(stack, {std::sqrt(1.0 - c * c), 0.0, c});
    }
    /// One that leaves the substrate in direction w of the lowest slab.
    Result from_below(const StackValues& stack, Vector w) {
        const int last = static_cast<int>(stack.size());
        if (!traverse(stack, last, w))
            return {End::Absorbed, 0.0, w};
        return travel(stack, last, w);
    }

private:
    static double ior(const StackValues& stack, int medium) {
        return medium == 0 ? 1.0 : stack[static_cast<std::size_t>(medium) - 1].ior;
    }
    /// Travels from the end of the slab that w points away from to one of its ends, which w then
    /// points at; false when absorbed on the way.
    bool traverse(const StackValues& stack, int medium, Vector& w) {
        if (medium == 0)
            return true;
        const LayerValues& layer = stack[static_cast<std::size_t>(medium) - 1];
        const double depth = layer.tau + layer.tau_scattering;
        double z = w.z < 0.0 ? depth : 0.0;
        while (true) {
            z -= std::log(1.0 - uniform()) * w.z;
            if (z <= 0.0 || z >= depth)
                return true;
            if (uniform() * depth < layer.tau)
                return false;
            w = deflect(w, henyey_greenstein(layer.anisotropy));
        }
    }
    double henyey_greenstein(double g) {
        if (g == 0.0)
            return 2.0 * uniform() - 1.0;
        const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * uniform());
        return (1.0 + g * g - s * s) / (2.0 * g);
    }
    Vector deflect(const Vector& w, double mu) {
        const Vector side = std::fabs(w.z) < 0.9 ? unit({w.y, -w.x, 0.0}) : unit({0.0, w.z, -w.y});
        const Vector other{w.y * side.z - w.z * side.y, w.z * side.x - w.x * side.z,
                           w.x * side.y - w.y * side.x};
        const double phi = 2.0 * M_PI * uniform(), s = std::sqrt(std::fmax(1.0 - mu * mu, 0.0));
        return unit(mu * w + (s * std::cos(phi)) * side + (s * std::sin(phi)) * other);
    }

    /// `medium` counts from the air; w is the direction of travel; the photon stands at the far
    /// end of its slab.
    Result travel(const StackValues& stack, int medium, Vector w) {
        const int substrate = static_cast<int>(stack.size());
        while (true) {
            if (w.z > 0.0 && medium == 0)
                return {End::Air, w.z, w};
            if (w.z < 0.0 && medium == substrate)
                return {End::Substrate, -w.z, w};
            const int next = w.z < 0.0 ? medium + 1 : medium - 1;
            const LayerValues& layer = stack[static_cast<std::size_t>(std::max(medium, next)) - 1];
            bool lost = false;
            const bool passed = cross(layer, ior(stack, medium), ior(stack, next), w, lost);
            if (lost)
                return {End::Lost, 0.0, w};
            medium = passed ? next : medium;
            if (!traverse(stack, medium, w))
                return {End::Absorbed, 0.0, w};
        }
    }

    /// Scatters w at an interface; true when it ends in the other medium.
    bool cross(const LayerValues& layer, double n_own, double n_other, Vector& w, bool& lost) {
        const bool upwards = w.z > 0.0;
        if (upwards) // always look from above
            w = upside_down(w);
        bool passed = false;
        if (layer.alpha == 0.0 || n_own == n_other)
            passed = scatter_smooth(n_own, n_other, w);
        else if (layer.scattering == Scattering::Single)
            passed = scatter_single(layer, n_own, n_other, w, lost);
        else
            passed = scatter_multiple(layer, n_own, n_other, w);
        if (upwards)
            w = upside_down(w);
        return passed;
    }

    bool scatter_smooth(double n_own, double n_other, Vector& w) {
        if (uniform() < fresnel(-w.z, n_own, n_other)) {
            w.z = -w.z;
            return false;
        }
        const double ratio = n_own / n_other;
        const double sin2 = ratio * ratio * (w.x * w.x + w.y * w.y);
        w = {ratio * w.x, ratio * w.y, -std::sqrt(1.0 - sin2)};
        return true;
    }

    static double lambda(const LayerValues& layer, const Vector& w) {
        const double tangent = std::sqrt(w.x * w.x + w.y * w.y) / w.z; // signed with w.z
        const double a = 1.0 / (layer.alpha * tangent);
        if (layer.distribution == Distribution::Ggx)
            return 0.5 * (-1.0 + std::copysign(std::sqrt(1.0 + 1.0 / (a * a)), a));
        return 0.5 * (std::erf(a) - 1.0) + std::exp(-a * a) / (2.0 * a * std::sqrt(M_PI));
    }

    /// A normal visible from v. The sampler is the kernels' own: it is tested against its density
    /// by itself, and rejection sampling takes minutes for the steep views of a walk.
    Vector visible_normal(const LayerValues& layer, const Vector& v) {
        const int distribution =
            layer.distribution == Distribution::Ggx ? MICROFACET_GGX : MICROFACET_BECKMANN;
        const double u1 = uniform(), u2 = uniform();
        const kernels::Vec3 m = kernels::microfacet_sample(distribution, layer.alpha,
                                                           kernels::vec3(v.x, v.y, v.z), u1, u2);
        return {m.x, m.y, m.z};
    }

    /// Reflection or refraction of v (pointing away) at facet m; true when refracted.
    bool facet(const Vector& v, const Vector& m, double n_own, double n_other, Vector& out) {
        const double c = dot(v, m);
        if (uniform() < fresnel(c, n_own, n_other)) {
            out = 2.0 * c * m + (-1.0) * v;
            return false;
        }
        const double ratio = n_own / n_other;
        const double ct = std::sqrt(1.0 - ratio * ratio * (1.0 - c * c));
        out = (ratio * c - ct) * m + (-ratio) * v;
        return true;
    }

    bool scatter_single(const LayerValues& layer, double n_own, double n_other, Vector& w,
                        bool& lost) {
        const Vector v = -1.0 * w;
        const bool passed = facet(v, visible_normal(layer, v), n_own, n_other, w);
        if (passed == (w.z > 0.0)) {
            lost = true;
            return passed;
        }
        const double li = lambda(layer, v), lo = lambda(layer, passed ? -1.0 * w : w);
        lost = uniform() > (1.0 + li) / (1.0 + li + lo);
        return passed;
    }

    /// Height as the share C of the surface below it, seen from the first medium.
    bool scatter_multiple(const LayerValues& layer, double n_own, double n_other, Vector& w) {
        double c = 1.0;
        bool passed = false;
        while (true) {
            // in the frame of the present medium
            const Vector ray = passed ? upside_down(w) : w;
            const double height = passed ? 1.0 - c : c;
            const double l = lambda(layer, ray);
            const double u = uniform();
            if (ray.z > 0.0 && u > 1.0 - std::pow(height, l))
                return passed;
            const double next = height / std::pow(1.0 - u, 1.0 / l);
            c = passed ? 1.0 - next : next;
            const Vector v = -1.0 * ray;
            Vector out{};
            const Vector m = visible_normal(layer, v);
            const bool through =
                passed ? facet(v, m, n_other, n_own, out) : facet(v, m, n_own, n_other, out);
            w = passed ? upside_down(out) : out;
            passed = through ? !passed : passed;
        }
    }

    std::mt19937_64 generator_;
    std::uniform_real_distribution<double> distribution_{0.0, 1.0};
};

} // namespace reradiant::reference
