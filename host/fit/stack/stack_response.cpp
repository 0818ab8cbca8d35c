#include "host/fit/stack/stack_response.h"

#include "host/spectral/matrix/linear_systems.h"
#include "reradiant/error.h"
#include "reradiant/stack_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Transports = std::vector<std::shared_ptr<const StackModel>>;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

double cosine(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180.0);
}

Transports transports_on(const LayerStack& stack, const WavelengthGrid& grid) {
    Transports transports;
    StackElements last;
    for (int band = 0; band < grid.count; ++band) {
        StackElements values = stack_at(stack, grid.centre_nm(band));
        transports.push_back(band > 0 && values == last ? transports.back()
                                                        : adding_transport(values));
        last = std::move(values);
    }
    return transports;
}

/// First band of a grid within the common one.
Eigen::Index offset_in(const WavelengthGrid& common, const WavelengthGrid& grid) {
    return static_cast<Eigen::Index>(std::lround((grid.from_nm - common.from_nm) / common.step_nm));
}

/// Fills the diagonal of B where it was not measured; returns in how many bands. A substrate of
/// reflectance rho alone has B = rho / (1 - r rho).
int guess_diagonal(const Eigen::VectorXd& r, const Eigen::VectorXd& measured, UncertainMatrix& b) {
    constexpr double variance_of_anything = 1.0 / 12.0; // uniform between 0 and 1
    std::vector<double> bands, reflectances;
    for (Eigen::Index k = 0; k < r.size(); ++k)
        if (measured(k) > 0.0) {
            bands.push_back(static_cast<double>(k));
            const double value = std::max(0.0, b.value(k, k));
            reflectances.push_back(std::min(1.0, value / (1.0 + r(k) * value)));
        }
    if (bands.empty())
        return 0;
    const Spectrum reflectance = Spectrum::table(bands, reflectances);
    for (Eigen::Index k = 0; k < r.size(); ++k) {
        if (measured(k) > 0.0)
            continue;
        const double rho = reflectance(static_cast<double>(k)), gain = 1.0 / (1.0 - r(k) * rho);
        b.value(k, k) = rho * gain;
        b.variance(k, k) = variance_of_anything * std::pow(gain, 4);
    }
    return static_cast<int>(r.size()) - static_cast<int>(bands.size());
}

} // namespace

WavelengthGrid common_grid(const BispectralData& data) {
    const double step = data.emission.step_nm;
    const double shift = (data.emission.from_nm - data.excitation.from_nm) / step;
    if (std::abs(data.excitation.step_nm - step) > 1e-6 * step ||
        std::abs(shift - std::round(shift)) > 1e-6)
        throw_input_error({data.file.string()},
                          "emission and excitation do not lie on one lattice of wavelengths, so "
                          "interreflections under a stack cannot be summed",
                          "measure both in the same steps");
    const double from = std::min(data.emission.from_nm, data.excitation.from_nm);
    const double to = std::max(data.emission.to_nm(), data.excitation.to_nm());
    return {from, step, static_cast<int>(std::lround((to - from) / step)) + 1};
}

StackResponse stack_response(const LayerStack& stack, const BispectralData& data) {
    const WavelengthGrid grid = common_grid(data);
    const Transports transports = transports_on(stack, grid);
    StackResponse response;
    response.internal_reflectance.resize(grid.count);
    for (int band = 0; band < grid.count; ++band)
        response.internal_reflectance(band) =
            transports[static_cast<std::size_t>(band)]->internal_reflectance();
    const auto first_out = static_cast<std::size_t>(offset_in(grid, data.emission));
    const auto first_in = static_cast<std::size_t>(offset_in(grid, data.excitation));
    for (const BispectralBlock& block : data.blocks) {
        Eigen::VectorXd out(data.emission.count);
        Eigen::RowVectorXd in(data.excitation.count);
        for (Eigen::Index o = 0; o < out.size(); ++o) {
            const StackModel& t = *transports[first_out + static_cast<std::size_t>(o)];
            out(o) = t.transmission(cosine(block.geometry->theta_o_deg)) /
                     (t.lowest_ior() * t.lowest_ior());
        }
        for (Eigen::Index i = 0; i < in.size(); ++i)
            in(i) = transports[first_in + static_cast<std::size_t>(i)]->transmission(
                cosine(block.geometry->theta_i_deg));
        response.gain.push_back(out * in);
    }
    return response;
}

UncertainMatrix under_the_stack(const BispectralData& data, const StackResponse& response,
                                const std::vector<Matrix>& weight) {
    Matrix sum = Matrix::Zero(data.emission.count, data.excitation.count), norm = sum;
    for (std::size_t b = 0; b < data.blocks.size(); ++b)
        for (Eigen::Index k = 0; k < sum.size(); ++k)
            if (weight[b](k) > 0.0) {
                const double gain = response.gain[b](k);
                sum(k) += weight[b](k) * gain * data.blocks[b].value(k);
                norm(k) += weight[b](k) * gain * gain;
            }
    UncertainMatrix under{sum, sum};
    for (Eigen::Index k = 0; k < sum.size(); ++k) {
        under.value(k) = norm(k) > 0.0 ? sum(k) / norm(k) : nan_value;
        under.variance(k) = norm(k) > 0.0 ? 1.0 / norm(k) : nan_value;
    }
    return under;
}

BareMatrix bare_matrix(const UncertainMatrix& under, const Eigen::VectorXd& r,
                       const BispectralData& data) {
    const WavelengthGrid grid = common_grid(data);
    const Eigen::Index o = offset_in(grid, data.emission), i = offset_in(grid, data.excitation);
    const Eigen::Index rows = under.value.rows(), columns = under.value.cols();
    UncertainMatrix full{Matrix::Zero(grid.count, grid.count),
                         Matrix::Zero(grid.count, grid.count)};
    Matrix measured = full.value;
    const auto known = (under.value.array() == under.value.array());
    full.value.block(o, i, rows, columns) = known.select(under.value, 0.0);
    full.variance.block(o, i, rows, columns) = known.select(under.variance, 0.0);
    measured.block(o, i, rows, columns) = known.cast<double>();
    BareMatrix bare;
    bare.guessed = guess_diagonal(r, measured.diagonal(), full);
    const Matrix identity = Matrix::Identity(grid.count, grid.count);
    const Matrix system = identity + r.asDiagonal() * full.value;
    const Matrix whole = right_quotient(full.value, system);
    const Matrix gaps = Matrix::Constant(rows, columns, nan_value);
    bare.value = known.select(whole.block(o, i, rows, columns), gaps);
    bare.errors.left = (identity - whole * r.asDiagonal()).middleRows(o, rows);
    bare.errors.right = (identity - r.asDiagonal() * whole).middleCols(i, columns);
    bare.errors.variance = full.variance;
    bare.own_variance =
        bare.errors.left.middleCols(o, rows).diagonal().cwiseAbs2().asDiagonal() *
        full.variance.block(o, i, rows, columns) *
        bare.errors.right.middleRows(i, columns).diagonal().cwiseAbs2().asDiagonal();
    return bare;
}

} // namespace reradiant
