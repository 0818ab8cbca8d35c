#include "host/fit/stack_response.h"

#include "host/error.h"
#include "host/layers/adding.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Transports = std::vector<std::shared_ptr<const AddingTransport>>;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

double cosine(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180.0);
}

Transports transports_on(const LayerStack& stack, const WavelengthGrid& grid) {
    Transports transports;
    StackValues last;
    for (int band = 0; band < grid.count; ++band) {
        const StackValues values = stack_at(stack, grid.centre_nm(band));
        transports.push_back(band > 0 && values == last ? transports.back()
                                                        : adding_transport(values));
        last = values;
    }
    return transports;
}

/// First band of a grid within the common one.
Eigen::Index offset_in(const WavelengthGrid& common, const WavelengthGrid& grid) {
    return static_cast<Eigen::Index>(std::lround((grid.from_nm - common.from_nm) / common.step_nm));
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
            const AddingTransport& t = *transports[first_out + static_cast<std::size_t>(o)];
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

UncertainMatrix bare_matrix(const UncertainMatrix& under, const Eigen::VectorXd& r,
                            const BispectralData& data) {
    const WavelengthGrid grid = common_grid(data);
    const Eigen::Index o = offset_in(grid, data.emission), i = offset_in(grid, data.excitation);
    const Eigen::Index rows = under.value.rows(), columns = under.value.cols();
    Matrix full = Matrix::Zero(grid.count, grid.count), variance = full;
    const auto known = (under.value.array() == under.value.array());
    full.block(o, i, rows, columns) = known.select(under.value, 0.0);
    variance.block(o, i, rows, columns) = known.select(under.variance, 0.0);
    const Matrix identity = Matrix::Identity(grid.count, grid.count);
    const Matrix system = identity + r.asDiagonal() * full;
    const Matrix bare = system.transpose().partialPivLu().solve(full.transpose()).transpose();
    const Matrix left = identity - bare * r.asDiagonal();
    const Matrix right = identity - r.asDiagonal() * bare;
    const Matrix spread = left.cwiseAbs2() * variance * right.cwiseAbs2();
    const Matrix gaps = Matrix::Constant(rows, columns, nan_value);
    return {known.select(bare.block(o, i, rows, columns), gaps),
            known.select(spread.block(o, i, rows, columns), gaps)};
}

} // namespace reradiant
