// Interference in one thin dielectric film between a dielectric and a dielectric or conductor.
#ifndef RERADIANT_THIN_FILM_H
#define RERADIANT_THIN_FILM_H

#include "kernels/core/portable.h"
#include "kernels/scatter/fresnel.h"

KERNELS_BEGIN

/// A `FilmPhase` describes a film between its faces: with phase x + 0i or 0 + ix, x = 2 pi d g /
/// wavelength and g = n_film cos_film, `cosine` is cos x and `sine` is sin(x) / g. Both are real
/// functions of g^2, also where the film is evanescent; there both are divided by cosh x, which a
/// reflectance does not see and which keeps thick films from overflowing.
typedef struct {
    real g2, cosine, sine;
} FilmPhase;

DEVICE_FUNCTION FilmPhase thin_film_phase(real g2, real thickness_nm, real wavelength_nm) {
    FilmPhase phase;
    real k = REAL(2.0) * PI_REAL * thickness_nm / wavelength_nm;
    real g = sqrt(fabs(g2));
    real x = k * g;
    phase.g2 = g2;
    if (x < REAL(1e-3)) {
        // sin x / x and its hyperbolic twin to x^4
        real x2 = g2 < REAL(0.0) ? -x * x : x * x;
        phase.cosine = REAL(1.0) - REAL(0.5) * x2;
        phase.sine = k * (REAL(1.0) - x2 / REAL(6.0));
    } else if (g2 > REAL(0.0)) {
        phase.cosine = cos(x);
        phase.sine = sin(x) / g;
    } else {
        real e = expm1(REAL(-2.0) * x);
        phase.cosine = REAL(1.0);
        phase.sine = -e / ((REAL(2.0) + e) * g);
    }
    return phase;
}

/// |Y0 B - C|^2 / |Y0 B + C|^2 times a common factor, for the numbers that the two polarisations
/// put in: Y0 and Y = y_over / y_under of incidence and base, `across` = sin / eta_film and `along`
/// = eta_film sin. Abeles' characteristic matrix, Born and Wolf 1.6.2, for n + i k:
/// B = cos - i across Y, C = Y cos - i along.
DEVICE_FUNCTION real thin_film_polarised(real y0_over, real y0_under, real over_re, real over_im,
                                         real under_re, real under_im, real cosine, real across,
                                         real along) {
    // B and C times y_under
    real b_re = cosine * under_re + across * over_im;
    real b_im = cosine * under_im - across * over_re;
    real c_re = cosine * over_re + along * under_im;
    real c_im = cosine * over_im - along * under_re;
    real less_re = y0_over * b_re - y0_under * c_re, less_im = y0_over * b_im - y0_under * c_im;
    real more_re = y0_over * b_re + y0_under * c_re, more_im = y0_over * b_im + y0_under * c_im;
    return (less_re * less_re + less_im * less_im) / (more_re * more_re + more_im * more_im);
}

/// Reflectance (unit 1) for unpolarised light that comes at cos_i >= 0 from a dielectric of IOR
/// n_incident onto a clear film of IOR n_film on a base n_base + i k_base; all IORs relative to
/// vacuum, thickness and vacuum wavelength in nm. It is the coherent sum of all orders inside the
/// film (Airy 1833; Born and Wolf 7.6). With a clear base the transmittance is one minus it; where
/// the base reflects totally it is exactly 1. Thickness 0 is the bare interface, bit for bit. The
/// same from both sides of a dielectric interface along one path.
DEVICE_FUNCTION real thin_film_reflectance(real cos_i, real n_incident, real n_film, real n_base,
                                           real k_base, real thickness_nm, real wavelength_nm) {
    real g0 = n_incident * cos_i;
    real e0 = n_incident * n_incident, ef = n_film * n_film;
    real eb_re = n_base * n_base - k_base * k_base, eb_im = REAL(2.0) * n_base * k_base;
    real gb2 = (n_base - n_incident) * (n_base + n_incident) + g0 * g0 - k_base * k_base;
    real gf2 = (n_film - n_incident) * (n_film + n_incident) + g0 * g0;
    real modulus, gb_re, gb_im, s, p;
    FilmPhase film;
    if (!(thickness_nm > REAL(0.0))) {
        return k_base > REAL(0.0)
                   ? fresnel_conductor(cos_i, n_base / n_incident, k_base / n_incident)
                   : fresnel_dielectric(cos_i, n_base / n_incident);
    }
    if (!(cos_i > REAL(0.0)) || (!(k_base > REAL(0.0)) && gb2 <= REAL(0.0)))
        return REAL(1.0);
    // gb = n cos of the base: the root with positive real and imaginary parts
    modulus = sqrt(gb2 * gb2 + eb_im * eb_im);
    if (gb2 > REAL(0.0)) {
        gb_re = sqrt(REAL(0.5) * (modulus + gb2));
        gb_im = REAL(0.5) * eb_im / gb_re;
    } else {
        gb_im = sqrt(REAL(0.5) * (modulus - gb2));
        gb_re = REAL(0.5) * eb_im / gb_im;
    }
    film = thin_film_phase(gf2, thickness_nm, wavelength_nm);
    // admittances n cos for s, n^2 / (n cos) for p
    s = thin_film_polarised(g0, REAL(1.0), gb_re, gb_im, REAL(1.0), REAL(0.0), film.cosine,
                            film.sine, film.g2 * film.sine);
    p = thin_film_polarised(e0, g0, eb_re, eb_im, gb_re, gb_im, film.cosine,
                            film.g2 * film.sine / ef, ef * film.sine);
    s = REAL(0.5) * (s + p);
    return s < REAL(1.0) ? s : REAL(1.0);
}

KERNELS_END

#endif
