#include "host/fit/stack/stack_inversion.h"

#include "host/fit/data/fit_target.h"
#include "host/fit/data/noise_estimate.h"
#include "host/fit/stack/stack_response.h"
#include "host/fit/stack/unknown_stack.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

/// "45/0", as the geometry line of a re-radiation CSV has it.
std::optional<BispectralGeometry> geometry_from_text(const std::string& text) {
    BispectralGeometry geometry{0.0, 0.0, 0.0};
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, geometry.theta_i_deg);
    if (first.ec != std::errc{} || first.ptr == end || *first.ptr != '/')
        return std::nullopt;
    const auto second = std::from_chars(first.ptr + 1, end, geometry.theta_o_deg);
    const bool good = second.ec == std::errc{} && second.ptr == end &&
                      geometry.theta_i_deg >= 0.0 && geometry.theta_i_deg < 90.0 &&
                      geometry.theta_o_deg >= 0.0 && geometry.theta_o_deg < 90.0;
    return good ? std::optional(geometry) : std::nullopt;
}

/// The data with a geometry in every block.
BispectralData with_geometries(BispectralData data) {
    for (BispectralBlock& block : data.blocks) {
        if (!block.geometry)
            block.geometry = geometry_from_text(data.geometry);
        if (!block.geometry)
            throw_input_error({data.file.string()},
                              "what a stack does cannot be undone without the directions of light "
                              "and detector",
                              "add a line `# geometry: 45/0` or give the CSV of `measure`");
    }
    return data;
}

/// Squared weights of every block: 1 / sigma^2 of its entry_errors, which also give the values.
std::vector<Matrix> block_weights(BispectralData& data, bool& is_estimated) {
    std::vector<Matrix> weights;
    is_estimated = true;
    for (BispectralBlock& block : data.blocks) {
        const Matrix known = (block.value.array() == block.value.array()).cast<double>();
        const EntryErrors errors = entry_errors(
            block.value, block.sigma,
            known.cwiseProduct(allowed_entries(data.emission, data.excitation, false)));
        is_estimated = is_estimated && errors.is_estimated;
        block.value = errors.value;
        weights.push_back(known.cwiseProduct(errors.sigma.cwiseAbs2().cwiseInverse()));
    }
    return weights;
}

/// Sets emission below the excitation to zero without error, since no substrate sends it upwards
/// unless it has anti-Stokes emission.
void darken_impossible(const BispectralData& data, UncertainMatrix& under) {
    for (int i = 0; i < data.excitation.count; ++i)
        for (int o = 0; o < data.emission.count; ++o)
            if (data.emission.centre_nm(o) < data.excitation.centre_nm(i) - 1e-6)
                under.value(o, i) = under.variance(o, i) = 0.0;
}

/// The substrate under a stack with these numbers.
class Inversion {
public:
    Inversion(const BispectralData& data, const std::vector<Matrix>& weights, bool anti_stokes)
        : data_(data), weights_(weights), anti_stokes_(anti_stokes) {}

    BareMatrix operator()(const LayerStack& stack) const {
        const StackResponse response = stack_response(stack, data_);
        UncertainMatrix under = under_the_stack(data_, response, weights_);
        if (!anti_stokes_)
            darken_impossible(data_, under);
        return bare_matrix(under, response.internal_reflectance, data_);
    }

private:
    const BispectralData& data_;
    const std::vector<Matrix>& weights_;
    bool anti_stokes_;
};

/// Returns how much the uncertainty of the stack's numbers changes every entry, direction by
/// direction.
std::vector<Matrix> stack_directions(const UnknownStack& unknown, const UnknownStackFit& fit,
                                     const Inversion& inversion) {
    std::vector<Matrix> directions;
    for (Eigen::Index k = 0; k < fit.root.cols(); ++k) {
        const Eigen::VectorXd step = 1e-3 * fit.root.col(k);
        directions.push_back((inversion(unknown.stack(fit.numbers + step)).value -
                              inversion(unknown.stack(fit.numbers - step)).value) /
                             2e-3);
    }
    return directions;
}

void note_guesses(const BispectralData& data, const BareMatrix& bare,
                  std::vector<std::string>& notes) {
    const WavelengthGrid grid = common_grid(data);
    if (data.emission.count < grid.count && data.emission.from_nm > data.excitation.from_nm)
        notes.push_back(fmt::format("emission below {} nm was not measured and is taken as dark in "
                                    "the interreflections",
                                    data.emission.from_nm));
    if (bare.guessed > 0)
        notes.push_back(fmt::format("the reflectance of {} bands was not measured: for the "
                                    "interreflections it is that of the nearest band, and its "
                                    "error may be anything",
                                    bare.guessed));
}

} // namespace

UnknownLayers unknown_layers_from_names(const std::vector<std::string>& names) {
    UnknownLayers unknown;
    for (const std::string& name : names)
        if (name == "thickness")
            unknown.thickness = true;
        else if (name == "absorption")
            unknown.absorption = true;
        else if (name == "ior")
            unknown.ior = true;
        else
            throw_input_error({}, fmt::format("--unknown {} is not known", name),
                              "write thickness, absorption, ior or a list of them");
    return unknown;
}

SubstrateData invert_stack(const BispectralData& data, const LayerStack& stack,
                           const UnknownLayers& unknown, bool anti_stokes) {
    const bool is_bare = data.blocks.size() == 1 && !data.blocks.front().geometry;
    if (stack.layers.empty() && unknown.any())
        throw_input_error({data.file.string()},
                          "something of a stack is unknown, but there is none",
                          "give --stack, too");
    if (stack.layers.empty() && is_bare)
        return {data, stack, {}, {}, false, {}};
    BispectralData measured = with_geometries(data);
    bool is_estimated = true;
    const std::vector<Matrix> weights = block_weights(measured, is_estimated);
    SubstrateData result{measured, stack, {}, {}, is_estimated, {}};
    const UnknownStack numbers(stack, unknown);
    UnknownStackFit fit;
    if (unknown.any()) {
        fit = fit_unknown_stack(numbers, measured, weights);
        result.stack = numbers.stack(fit.numbers);
        result.estimate = fit.estimate;
    }
    const Inversion inversion(measured, weights, anti_stokes);
    BareMatrix bare = inversion(result.stack);
    if (unknown.any())
        bare.errors.directions = stack_directions(numbers, fit, inversion);
    const Matrix gaps = 0.0 * bare.value; // NaN where nothing was measured
    result.data.blocks.assign(1, {std::nullopt, bare.value, bare.own_variance.cwiseSqrt() + gaps});
    note_guesses(measured, bare, result.notes);
    result.errors = std::move(bare.errors);
    return result;
}

} // namespace reradiant
