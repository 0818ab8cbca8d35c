#include "kernels/scatter/microfacet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

using namespace reradiant::kernels;

namespace {

constexpr std::array distributions{MICROFACET_BLINN, MICROFACET_BECKMANN, MICROFACET_GGX};
constexpr std::array alphas{0.01, 0.1, 0.5, 1.0};

Vec3 direction(double cosine, double phi) {
    const double s = std::sqrt(1.0 - cosine * cosine);
    return vec3(s * std::cos(phi), s * std::sin(phi), cosine);
}

/// Integral over half vectors; steps gather at the normal so that narrow lobes are resolved.
template <typename Function>
double integrate_normals(const Function& f) {
    const int steps = 1500, azimuths = 128;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double u = (i + 0.5) / steps;
        const double theta = u * u * u * M_PI / 2, width = 3 * u * u * M_PI / 2 / steps;
        for (int k = 0; k < azimuths; ++k) {
            const double phi = 2 * M_PI * (k + 0.5) / azimuths;
            const Vec3 h = vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                std::cos(theta));
            sum += f(h) * std::sin(theta) * width * 2 * M_PI / azimuths;
        }
    }
    return sum;
}

} // namespace

TEST(Microfacet, ProjectedNormalsFillTheSurface) {
    for (const int d : distributions) {
        for (const double alpha : alphas) {
            const double area =
                integrate_normals([&](Vec3 h) { return microfacet_d(d, alpha, h) * h.z; });
            EXPECT_NEAR(area, 1.0, 1e-4) << d << " " << alpha; // the quadrature's own error
        }
    }
}

TEST(Microfacet, SmithMaskingKeepsTheProjectedAreaOfVisibleFacets) {
    for (const int d : {MICROFACET_BECKMANN, MICROFACET_GGX}) {
        for (const double alpha : alphas) {
            for (const double c : {1.0, 0.5, 0.1}) {
                const Vec3 w = direction(c, 0.3);
                const double area = integrate_normals([&](Vec3 h) {
                    return microfacet_d(d, alpha, h) * std::fmax(vec3_dot(w, h), 0.0);
                });
                const double expected = c * (1.0 + microfacet_lambda(d, alpha, w));
                EXPECT_NEAR(area / expected, 1.0, 5e-4) << d << " " << alpha << " " << c;
            }
        }
    }
}

TEST(Microfacet, DensityIntegratesToOneAndSamplesFollowIt) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (const int d : distributions) {
        for (const double alpha : alphas) {
            for (const double c : {1.0, 0.6, 0.08}) {
                const Vec3 w = direction(c, 1.1);
                std::array<double, 4> expected{};
                expected[0] =
                    integrate_normals([&](Vec3 h) { return microfacet_pdf(d, alpha, w, h); });
                EXPECT_NEAR(expected[0], 1.0, 1e-3) << d << " " << alpha << " " << c;
                // chi-square over quadrants towards and across the viewer, and steep or flat
                std::array<double, 8> cells{}, found{};
                const auto cell = [&](Vec3 h) {
                    const double along = h.x * std::cos(1.1) + h.y * std::sin(1.1);
                    const double across = h.y * std::cos(1.1) - h.x * std::sin(1.1);
                    const bool steep = std::hypot(h.x, h.y) > 0.8 * alpha * h.z;
                    return static_cast<std::size_t>((along > 0) + 2 * (across > 0) + 4 * steep);
                };
                for (std::size_t k = 0; k < cells.size(); ++k) {
                    cells[k] = integrate_normals([&](Vec3 h) {
                        return cell(h) == k ? microfacet_pdf(d, alpha, w, h) : 0.0;
                    });
                }
                const int samples = 20000;
                for (int i = 0; i < samples; ++i) {
                    const double u1 = uniform(generator), u2 = uniform(generator);
                    found[cell(microfacet_sample(d, alpha, w, u1, u2))] += 1.0;
                }
                double chi2 = 0.0;
                for (std::size_t k = 0; k < cells.size(); ++k) {
                    const double mean = cells[k] * samples;
                    if (mean > 5.0)
                        chi2 += (found[k] - mean) * (found[k] - mean) / mean;
                }
                // 36 tests at a family-wise rate of 1e-6: chi-square of 7 degrees at 3e-8 is 48;
                // the quadrature adds about 3. A lobe 1 % too wide moves it by hundreds.
                EXPECT_LT(chi2, 51.0) << d << " " << alpha << " " << c;
            }
        }
    }
}

TEST(Microfacet, Case08NarrowGgxFollowsItsTangentForm) {
    for (const double alpha : {1e-3, 1e-4}) {
        const double t = 0.7 * alpha;
        const Vec3 h = vec3(t, 0.0, std::sqrt(1.0 - t * t));
        const double tan2 = t * t / (1.0 - t * t);
        const double q = (1.0 - t * t) * (1.0 + tan2 / (alpha * alpha));
        EXPECT_NEAR(microfacet_d(MICROFACET_GGX, alpha, h) * M_PI * alpha * alpha * q * q, 1.0,
                    1e-12);
    }
}

TEST(Microfacet, Case01ReflectionIsReciprocalAndFiniteAtGrazing) {
    for (const int d : distributions) {
        for (const double alpha : alphas) {
            const Vec3 a = direction(0.7, 0.2);
            for (const double c : {1.0, 0.3, 1e-4, 1e-8}) {
                const Vec3 b = direction(c, 2.9);
                const double f = microfacet_reflection(d, alpha, a, b);
                EXPECT_TRUE(std::isfinite(f));
                EXPECT_NEAR(f, microfacet_reflection(d, alpha, b, a), 1e-9 * f);
                EXPECT_NEAR(f * c, microfacet_reflection_cos(d, alpha, b, a), 1e-12 * (1 + f));
            }
            EXPECT_EQ(microfacet_reflection(d, alpha, a, vec3(1.0, 0.0, 0.0)), 0.0);
        }
    }
}
