#include "reradiant/reradiation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

/// Widest piece of an excitation cell that is treated as one wavelength.
constexpr double quadrature_step_nm = 0.25;

/// Integral of e(l) l dl from any wavelength to the end of the emission, from a running sum from
/// the red end: small values far up the red tail keep their relative precision.
class PhotonIntegral {
public:
    PhotonIntegral(const Spectrum& emission, double from_nm, double to_nm)
        : emission_(emission), from_nm_(from_nm) {
        const int pieces =
            std::max(1, static_cast<int>(std::ceil((to_nm - from_nm) / quadrature_step_nm)));
        step_nm_ = (to_nm - from_nm) / pieces;
        above_.assign(static_cast<std::size_t>(pieces) + 1, 0.0);
        for (int piece = pieces - 1; piece >= 0; --piece)
            above_[static_cast<std::size_t>(piece)] =
                above_[static_cast<std::size_t>(piece) + 1] +
                between(from_nm + piece * step_nm_, from_nm + (piece + 1) * step_nm_);
    }

    double above(double wavelength_nm) const {
        const double position = std::max(0.0, (wavelength_nm - from_nm_) / step_nm_);
        const auto next = static_cast<std::size_t>(std::ceil(position));
        if (next >= above_.size())
            return 0.0;
        return above_[next] +
               between(wavelength_nm, from_nm_ + static_cast<double>(next) * step_nm_);
    }

private:
    double between(double a, double b) const {
        return b > a ? emission_.average(a, b) * 0.5 * (a + b) * (b - a) : 0.0;
    }

    const Spectrum& emission_;
    double from_nm_, step_nm_ = 1.0;
    std::vector<double> above_;
};

void require_usable(const Fluorophore& fluorophore, const WavelengthGrid& emission,
                    const WavelengthGrid& excitation) {
    constexpr double rounding = 1e-9;
    const double from = excitation.lower_edge_nm(0),
                 to = excitation.upper_edge_nm(excitation.count - 1);
    if (!(fluorophore.quantum_yield >= 0.0 && std::isfinite(fluorophore.quantum_yield)))
        throw std::invalid_argument(fmt::format("the quantum yield {} is not a number from 0 up",
                                                fluorophore.quantum_yield));
    if (fluorophore.excitation.minimum(from, to) < -rounding ||
        fluorophore.excitation.maximum(from, to) > 1.0 + rounding)
        throw std::invalid_argument(
            "the excitation of a fluorophore is a fraction of photons, from 0 to 1");
    if (fluorophore.emission.minimum(emission.lower_edge_nm(0),
                                     emission.upper_edge_nm(emission.count - 1)) < -rounding)
        throw std::invalid_argument("the emission of a fluorophore is negative somewhere");
}

/// Means of e over every emission cell, and over what of it lies above a wavelength.
class EmissionCells {
public:
    EmissionCells(const Spectrum& emission, const WavelengthGrid& grid)
        : emission_(emission), grid_(grid) {
        for (int o = 0; o < grid.count; ++o)
            whole_.push_back(emission.average(grid.lower_edge_nm(o), grid.upper_edge_nm(o)));
    }
    double above(int o, double wavelength_nm) const {
        const double lower = grid_.lower_edge_nm(o), upper = grid_.upper_edge_nm(o);
        if (wavelength_nm <= lower)
            return whole_[static_cast<std::size_t>(o)];
        if (wavelength_nm >= upper)
            return 0.0;
        return emission_.average(wavelength_nm, upper) * (upper - wavelength_nm) / grid_.step_nm;
    }

private:
    const Spectrum& emission_;
    const WavelengthGrid& grid_;
    std::vector<double> whole_;
};

/// Calls visit(i, li, absorbed, normal) for every piece of every excitation cell: the piece around
/// li adds absorbed / normal times the mean of e over what of an emission cell lies above li.
template <typename Visit>
void for_each_piece(const Fluorophore& fluorophore, const WavelengthGrid& emission,
                    const WavelengthGrid& excitation, const Visit& visit) {
    const double from_nm = std::max(1e-3, excitation.lower_edge_nm(0));
    const double to_nm = std::max(emission.upper_edge_nm(emission.count - 1),
                                  fluorophore.emission.described_to_nm());
    const PhotonIntegral photons(fluorophore.emission, from_nm, std::max(from_nm + 1.0, to_nm));
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(excitation.step_nm / quadrature_step_nm)));
    const double piece_nm = excitation.step_nm / pieces;
    for (int i = 0; i < excitation.count; ++i)
        for (int piece = 0; piece < pieces; ++piece) {
            const double a = excitation.lower_edge_nm(i) + piece * piece_nm;
            const double li = a + 0.5 * piece_nm;
            const double normal = photons.above(li);
            // Below the smallest normal number a ratio of tails has no digits left.
            if (li > 0.0 && normal > 1e-290)
                visit(i, li,
                      fluorophore.quantum_yield * fluorophore.excitation.average(a, a + piece_nm) *
                          li * piece_nm,
                      normal);
        }
}

void add_fluorophore(const Fluorophore& fluorophore, ReradiationMatrix& matrix) {
    const EmissionCells cells(fluorophore.emission, matrix.emission);
    for_each_piece(fluorophore, matrix.emission, matrix.excitation,
                   [&](int i, double li, double absorbed, double normal) {
                       for (int o = 0; o < matrix.emission.count; ++o)
                           matrix.values(o, i) += absorbed * (cells.above(o, li) / normal);
                   });
}

/// Factors of one fluorophore, the largest emission 1. Where all that an excitation cell sends
/// above itself is nothing beside the rest it has none: tails would span hundreds of orders.
void set_factors(const Fluorophore& fluorophore, const WavelengthGrid& cells,
                 Eigen::Ref<Eigen::VectorXd> emission, Eigen::Ref<Eigen::VectorXd> excitation) {
    constexpr double nothing = 1e-12;
    for (int o = 0; o < cells.count; ++o)
        emission(o) = fluorophore.emission.average(cells.lower_edge_nm(o), cells.upper_edge_nm(o));
    const double largest = emission.maxCoeff();
    if (!(largest > 0.0))
        return;
    for_each_piece(fluorophore, cells, cells, [&](int i, double, double absorbed, double normal) {
        excitation(i) += absorbed * (largest / normal);
    });
    emission /= largest;
    Eigen::VectorXd sent = excitation;
    double most_above = 0.0;
    for (int i = cells.count - 1; i >= 0; --i) {
        sent(i) *= most_above;
        most_above = std::max(most_above, emission(i));
    }
    excitation = (sent.array() > nothing * sent.maxCoeff()).select(excitation, 0.0);
}

} // namespace

ReradiationMatrix matrix_from_fluorophores(const std::vector<Fluorophore>& fluorophores,
                                           const Spectrum& reflectance,
                                           const WavelengthGrid& emission,
                                           const WavelengthGrid& excitation) {
    ReradiationMatrix matrix;
    matrix.emission = emission;
    matrix.excitation = excitation;
    matrix.values.setZero(emission.count, excitation.count);
    for (const Fluorophore& fluorophore : fluorophores) {
        require_usable(fluorophore, emission, excitation);
        add_fluorophore(fluorophore, matrix);
    }
    for (int i = 0; i < excitation.count; ++i)
        if (const int o = diagonal_row(matrix, i); o >= 0)
            matrix.values(o, i) +=
                reflectance.average(excitation.lower_edge_nm(i), excitation.upper_edge_nm(i));
    return matrix;
}

MaskedFactors factors_of_fluorophores(const std::vector<Fluorophore>& fluorophores,
                                      const WavelengthGrid& cells) {
    const auto rank = static_cast<Eigen::Index>(fluorophores.size());
    MaskedFactors factors{Eigen::MatrixXd::Zero(cells.count, rank),
                          Eigen::MatrixXd::Zero(cells.count, rank), 0.0};
    for (Eigen::Index k = 0; k < rank; ++k) {
        const Fluorophore& fluorophore = fluorophores[static_cast<std::size_t>(k)];
        require_usable(fluorophore, cells, cells);
        set_factors(fluorophore, cells, factors.emission.col(k), factors.excitation.col(k));
    }
    return factors;
}

} // namespace reradiant
