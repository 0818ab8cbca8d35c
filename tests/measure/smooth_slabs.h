#pragma once

#include "reradiant/layer_stack.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace reradiant::test {

/// A stack of smooth slabs in a closed form of its own: Stokes' series of interreflections
/// summed term by term, integrals by Simpson's rule.
struct SmoothSlabs {
    std::vector<double> ior{1.0}, tau{0.0};

    double cosine(std::size_t medium, double q) const {
        return std::sqrt(std::max(1.0 - q / (ior[medium] * ior[medium]), 0.0));
    }
    double fresnel(std::size_t above, double q) const {
        const double n1 = ior[above], n2 = ior[above + 1];
        const double c1 = cosine(above, q), c2 = cosine(above + 1, q);
        if (q >= n1 * n1 || q >= n2 * n2)
            return 1.0;
        const double s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        const double p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
        return 0.5 * (s * s + p * p);
    }
    struct Shares {
        double down, back, up_back;
    };
    /// Transmission to the substrate, reflection to the air, reflection from below.
    Shares shares(double q) const {
        Shares total{1.0, 0.0, 0.0};
        for (std::size_t k = 0; k + 1 < ior.size(); ++k) {
            const double f = fresnel(k, q), c = cosine(k + 1, q);
            // add interface k under what is there
            double through = 0.0, back = 0.0, up = f, flux = total.down, inner = (1 - f);
            for (int order = 0; order < 4000; ++order) {
                through += flux * (1 - f);
                back += flux * f * total.down;
                up += inner * total.up_back * (1 - f);
                flux *= f * total.up_back;
                inner *= total.up_back * f;
            }
            const double a = tau[k + 1] > 0 ? std::exp(-tau[k + 1] / c) : 1.0;
            total = {through * a, total.back + back, up * a * a};
        }
        return total;
    }
    double transmission(double theta) const {
        return shares(std::pow(std::sin(theta * M_PI / 180), 2)).down;
    }
    double specular(double theta) const {
        return shares(std::pow(std::sin(theta * M_PI / 180), 2)).back;
    }
    /// 2 integral R_up c dc in the lowest medium over pieces between critical angles.
    double internal() const {
        const double n = ior.back();
        std::vector<double> edges{0.0, n * n};
        for (const double other : ior)
            if (other < n)
                edges.push_back(other * other);
        std::sort(edges.begin(), edges.end());
        double sum = 0.0;
        for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
            const int steps = 400;
            for (int i = 0; i <= steps; ++i) {
                const double u = 0.5 * M_PI * i / steps, s = std::sin(u);
                const double w = i == 0 || i == steps ? 1 : (i % 2 == 1 ? 4 : 2);
                const double q = edges[k] + (edges[k + 1] - edges[k]) * s * s;
                sum += w * shares(q).up_back * std::sin(2 * u) * (edges[k + 1] - edges[k]) * 0.5 *
                       M_PI / steps / 3;
            }
        }
        return sum / (n * n);
    }
    /// The share of diffuse light below that leaves: 2 integral T sin cos over the angles in air,
    /// over n^2, by Simpson's rule in an angle that clusters at both ends.
    double external() const {
        const int steps = 2000;
        double sum = 0.0;
        for (int i = 0; i <= steps; ++i) {
            const double u = 0.5 * M_PI * i / steps, s = std::sin(u);
            const double w = i == 0 || i == steps ? 1 : (i % 2 == 1 ? 4 : 2);
            sum += w * shares(s * s).down * std::sin(2 * u) * 0.5 * M_PI / steps / 3;
        }
        return sum / (ior.back() * ior.back());
    }
};

inline LayerStack stack_of(const SmoothSlabs& slabs) {
    LayerStack stack;
    for (std::size_t k = 1; k < slabs.ior.size(); ++k) {
        Layer layer;
        layer.ior = Spectrum::constant(slabs.ior[k]);
        layer.absorption = Spectrum::constant(slabs.tau[k]);
        stack.layers.push_back(layer);
    }
    return stack;
}

/// Reflectance plus a Stokes shift from 400 to 500 and 600 nm and from 500 to 600 nm.
inline Eigen::MatrixXd stokes_matrix() {
    Eigen::MatrixXd m(3, 3);
    m << 0.3, 0, 0, 0.2, 0.5, 0, 0.15, 0.1, 0.8;
    return m;
}
inline const WavelengthGrid grid{400, 100, 3};

/// M (1 - R M)^-1 by its series.
inline Eigen::MatrixXd interreflected(const Eigen::MatrixXd& m, double r) {
    Eigen::MatrixXd sum = m, term = m;
    for (int order = 0; order < 2000; ++order) {
        term = (r * m * term).eval();
        sum += term;
    }
    return sum;
}

} // namespace reradiant::test
