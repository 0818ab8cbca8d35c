#include "host/spectral/matrix/kubelka_munk.h"

#include <Eigen/LU>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

// Two fluxes at all wavelengths at once, I downwards and J upwards, vectors over bands (Emmel and
// Hersch 1999 write fluorescent inks so; Shakespeare and Shakespeare 2003 solve one wavelength
// after the other). With F(o, i) the power that the dyes turn from i to o per unit of thickness:
//
//     I' = -(K + S) I + S J + F (I + J) / 2,      -J' = -(K + S) J + S I + F (I + J) / 2.
//
// For P = I + J and M = I - J the halves of F cancel in one equation:
//
//     P' = -(K + 2S) M,      M' = -(K - F) P,      hence P'' = A P with A = (K + 2S)(K - F).
//
// Dyes emit at longer wavelengths only, so A is lower triangular. An opaque layer keeps the
// decaying solution P = exp(-G z) P(0), G = sqrt(A): M = W P with W = (K + 2S)^-1 G, and
// J = R I at the top gives R = (1 + W)^-1 (1 - W), for one wavelength the formula of Kubelka and
// Munk. Columns of K - F have sums >= 0 (in power, and in photons), so R never gains any.

namespace reradiant {

namespace {

constexpr double FROM_NM = 200.0, TO_NM = 1000.0;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Coefficients of a layer on bands.
struct Coefficients {
    Vector absorption, scattering;
    Matrix emission; ///< F, rows = emission
};

Coefficients coefficients_on(const PigmentLayer& layer, const WavelengthGrid& grid) {
    Coefficients c{Vector::Zero(grid.count), Vector::Zero(grid.count),
                   Matrix::Zero(grid.count, grid.count)};
    const auto add = [&](Vector& sum, const Spectrum& spectrum, double factor) {
        for (int band = 0; band < grid.count; ++band)
            sum(band) +=
                factor * spectrum.average(grid.lower_edge_nm(band), grid.upper_edge_nm(band));
    };
    for (const Pigment& pigment : layer.pigments) {
        add(c.absorption, pigment.absorption, pigment.concentration);
        add(c.scattering, pigment.scattering, pigment.concentration);
    }
    for (const Dye& dye : layer.dyes) {
        add(c.absorption, dye.absorption, dye.concentration);
        // As a fluorophore that absorbs the share K / peak, since shares end at 1.
        const double peak =
            dye.absorption.maximum(grid.lower_edge_nm(0), grid.upper_edge_nm(grid.count - 1));
        if (peak <= 0.0)
            continue;
        const Fluorophore share{dye.absorption.scaled(1.0 / peak), dye.emission, dye.quantum_yield};
        c.emission += peak * dye.concentration *
                      matrix_from_fluorophores({share}, Spectrum(), grid, grid).values;
    }
    return c;
}

/// Principal square root of a lower triangular matrix with a diagonal >= 0 (Bjoerck and Hammarling
/// 1983; max: against rounding below 0). Where two diagonal entries are 0 a band that absorbs
/// nothing excites nothing: 0.
Matrix square_root(const Matrix& lower) {
    const Eigen::Index n = lower.rows();
    Matrix root = Matrix::Zero(n, n);
    for (Eigen::Index i = n - 1; i >= 0; --i) { // a column needs those to its right
        root(i, i) = std::sqrt(std::max(0.0, lower(i, i)));
        for (Eigen::Index o = i + 1; o < n; ++o) {
            const double own = std::sqrt(std::max(0.0, lower(o, o)));
            const Eigen::Index between = o - i - 1;
            const double rest =
                lower(o, i) -
                root.row(o).segment(i + 1, between).dot(root.col(i).segment(i + 1, between));
            root(o, i) = own + root(i, i) > 0.0 ? rest / (own + root(i, i)) : 0.0;
        }
    }
    return root;
}

Matrix inverse_lower(const Matrix& lower) {
    return lower.triangularView<Eigen::Lower>().solve(Matrix::Identity(lower.rows(), lower.cols()));
}

Matrix opaque_reflectance(const Coefficients& c) {
    const Vector both = c.absorption + 2.0 * c.scattering;
    const Matrix loss = Matrix(c.absorption.asDiagonal()) - c.emission;
    const Matrix w = both.cwiseInverse().asDiagonal() * square_root(both.asDiagonal() * loss);
    const Matrix one = Matrix::Identity(w.rows(), w.cols());
    return inverse_lower(one + w) * (one - w);
}

/// A `Slab` is what a slab in black surroundings reflects and transmits, the same from both sides.
struct Slab {
    Matrix reflectance, transmittance;
};

/// A slab so thin that the series of cosh and sinh in (K + 2S)(K - F) h^2 ends after few terms.
Slab thin_slab(const Coefficients& c, double h) {
    constexpr int TERMS = 5; // the argument is at most 0.1^2: the next term is below 1e-20
    const Vector both = h * (c.absorption + 2.0 * c.scattering);
    const Matrix loss = h * (Matrix(c.absorption.asDiagonal()) - c.emission);
    const Matrix product = both.asDiagonal() * loss, swapped = loss * both.asDiagonal();
    const Matrix one = Matrix::Identity(loss.rows(), loss.cols());
    Matrix cosh = one, cosh_swapped = one, sinh = one; // sinh: over its argument
    Matrix power = one, power_swapped = one;
    double factorial = 1.0;
    for (int k = 1; k <= TERMS; ++k) {
        power = power * product;
        power_swapped = power_swapped * swapped;
        factorial *= (2.0 * k - 1.0) * (2.0 * k);
        cosh += power / factorial;
        cosh_swapped += power_swapped / factorial;
        sinh += power / (factorial * (2.0 * k + 1.0));
    }
    const Matrix p = cosh + sinh * both.asDiagonal(), m = cosh_swapped + loss * sinh;
    Slab slab;
    slab.transmittance = 2.0 * inverse_lower(p + m);
    slab.reflectance = 0.5 * (p - m) * slab.transmittance;
    return slab;
}

/// Returns the reflectance of a layer: a thin slab is doubled until it is as thick as the layer
/// (van de Hulst 1963), then laid on the backing.
Matrix finite_reflectance(const Coefficients& c, double thickness, const Vector& backing) {
    constexpr double THIN = 0.1;
    const double depth = (c.absorption + 2.0 * c.scattering).maxCoeff() * thickness;
    const int doublings = depth > THIN ? static_cast<int>(std::ceil(std::log2(depth / THIN))) : 0;
    Slab slab = thin_slab(c, std::ldexp(thickness, -doublings));
    const Matrix one = Matrix::Identity(backing.size(), backing.size());
    for (int k = 0; k < doublings; ++k) {
        const Matrix between =
            inverse_lower(one - slab.reflectance * slab.reflectance) * slab.transmittance;
        slab.reflectance += slab.transmittance * slab.reflectance * between;
        slab.transmittance = slab.transmittance * between;
    }
    const Matrix arriving =
        inverse_lower(one - slab.reflectance * backing.asDiagonal()) * slab.transmittance;
    return slab.reflectance + slab.transmittance * backing.asDiagonal() * arriving;
}

} // namespace

double PigmentLayer::absorption(double wavelength_nm) const {
    double sum = 0.0;
    for (const Pigment& pigment : pigments)
        sum += pigment.concentration * pigment.absorption(wavelength_nm);
    for (const Dye& dye : dyes)
        sum += dye.concentration * dye.absorption(wavelength_nm);
    return sum;
}

double PigmentLayer::scattering(double wavelength_nm) const {
    double sum = 0.0;
    for (const Pigment& pigment : pigments)
        sum += pigment.concentration * pigment.scattering(wavelength_nm);
    return sum;
}

bool PigmentLayer::is_fluorescent() const {
    return std::any_of(dyes.begin(), dyes.end(), [](const Dye& dye) {
        return dye.quantum_yield > 0.0 && dye.concentration > 0.0 && !dye.absorption.is_zero();
    });
}

double kubelka_munk_reflectance(double k, double s, double thickness, double backing) {
    const double both = k + 2.0 * s;
    if (std::isinf(thickness) && both == 0.0)
        throw std::invalid_argument("an opaque layer neither absorbs nor scatters");
    const double root = std::sqrt(k) * std::sqrt(both); // k (k + 2s) could leave the range
    const double below = (1.0 - backing) / (1.0 + backing);
    double ratio = std::sqrt(k / both); // of (I - J) to (I + J) at the top
    if (!std::isinf(thickness)) {
        const double tangent = root > 0.0 ? std::tanh(root * thickness) / root : thickness;
        ratio = (below + k * tangent) / (1.0 + tangent * both * below);
    }
    return (1.0 - ratio) / (1.0 + ratio);
}

Spectrum kubelka_munk_spectrum(const PigmentLayer& layer) {
    const auto at = [&](double nm) {
        try {
            return kubelka_munk_reflectance(layer.absorption(nm), layer.scattering(nm),
                                            layer.thickness, layer.backing(nm));
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("{} at {} nm", error.what(), nm));
        }
    };
    const auto constant = [](const auto& parts) {
        return std::all_of(parts.begin(), parts.end(),
                           [](const auto& part) { return part.absorption.is_constant(); });
    };
    const bool grey =
        constant(layer.pigments) && constant(layer.dyes) && layer.backing.is_constant() &&
        std::all_of(layer.pigments.begin(), layer.pigments.end(),
                    [](const Pigment& pigment) { return pigment.scattering.is_constant(); });
    if (grey)
        return Spectrum::constant(at(FROM_NM));
    std::vector<double> wavelengths_nm, values;
    for (double nm = FROM_NM; nm <= TO_NM; nm += 1.0) {
        wavelengths_nm.push_back(nm);
        values.push_back(at(nm));
    }
    return Spectrum::table(std::move(wavelengths_nm), std::move(values));
}

ReradiationMatrix kubelka_munk_matrix(const PigmentLayer& layer, const WavelengthGrid& grid) {
    const Coefficients c = coefficients_on(layer, grid);
    ReradiationMatrix matrix;
    matrix.emission = grid;
    matrix.excitation = grid;
    if (!std::isinf(layer.thickness)) {
        Vector backing(grid.count);
        for (int band = 0; band < grid.count; ++band)
            backing(band) =
                layer.backing.average(grid.lower_edge_nm(band), grid.upper_edge_nm(band));
        matrix.values = finite_reflectance(c, layer.thickness, backing);
        return matrix;
    }
    for (int band = 0; band < grid.count; ++band)
        if (c.absorption(band) + c.scattering(band) == 0.0)
            throw std::invalid_argument(fmt::format(
                "an opaque layer neither absorbs nor scatters at {} nm", grid.centre_nm(band)));
    matrix.values = opaque_reflectance(c);
    return matrix;
}

} // namespace reradiant
