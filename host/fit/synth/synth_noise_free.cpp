#include "reradiant/synth.h"

#include "host/layers/stack/joined_layers.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"

#include <Eigen/Core>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace reradiant {

namespace {

/// Samples a bandpass or a step is resolved by, and the largest matrix that is worth it.
constexpr double samples_per_width = 5.0;
constexpr int most_fine_bands = 2000;

bool has_bandpass(const SynthInstrument& instrument) {
    return instrument.excitation_fwhm_nm > 0.0 || instrument.emission_fwhm_nm > 0.0;
}

/// The grid that holds both grids' bands, which a stack acts on.
WavelengthGrid union_of(const WavelengthGrid& a, const WavelengthGrid& b) {
    const double shift = (b.from_nm - a.from_nm) / a.step_nm;
    if (std::abs(a.step_nm - b.step_nm) > 1e-9 || std::abs(shift - std::round(shift)) > 1e-6)
        throw std::invalid_argument("emission and excitation bands are not parts of one grid, "
                                    "which a measurement in directions needs");
    return grid_from_range(std::min(a.from_nm, b.from_nm), std::max(a.to_nm(), b.to_nm()),
                           a.step_nm);
}

/// A grid that resolves both bandpasses and reaches beyond both grids by one of them.
WavelengthGrid fine_grid(const SynthRecipe& recipe) {
    double width = std::min(recipe.emission.step_nm, recipe.excitation.step_nm), reach = 0.0;
    for (const double fwhm :
         {recipe.instrument.excitation_fwhm_nm, recipe.instrument.emission_fwhm_nm}) {
        width = fwhm > 0.0 ? std::min(width, fwhm) : width;
        reach = std::max(reach, fwhm);
    }
    reach = std::max({reach, recipe.emission.step_nm, recipe.excitation.step_nm});
    const double step = width / samples_per_width;
    const double from =
        std::max(step, std::min(recipe.emission.from_nm, recipe.excitation.from_nm) - reach);
    const double to = std::max(recipe.emission.to_nm(), recipe.excitation.to_nm()) + reach;
    const double bands = std::ceil((to - from) / step) + 1.0;
    if (bands > most_fine_bands)
        throw std::invalid_argument(fmt::format(
            "bandpasses of this width need {} bands, more than {}", bands, most_fine_bands));
    return {from, step, static_cast<int>(bands)};
}

/// Weights of the fine bands in what each band of `bands` sees, rows add up to 1: a triangle of
/// the given width, or the band's own cell.
Eigen::MatrixXd bandpass(const WavelengthGrid& bands, const WavelengthGrid& fine, double fwhm_nm) {
    Eigen::MatrixXd weights(bands.count, fine.count);
    for (int band = 0; band < bands.count; ++band)
        for (int k = 0; k < fine.count; ++k) {
            const double overlap = std::min(bands.upper_edge_nm(band), fine.upper_edge_nm(k)) -
                                   std::max(bands.lower_edge_nm(band), fine.lower_edge_nm(k));
            const double away = std::abs(fine.centre_nm(k) - bands.centre_nm(band));
            weights(band, k) = std::max(0.0, fwhm_nm > 0.0 ? 1.0 - away / fwhm_nm : overlap);
        }
    return weights.array().colwise() / weights.rowwise().sum().array();
}

std::vector<double> each_once(std::vector<double> angles) {
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
    return angles;
}

/// Every combination of the geometries' angles, so that the stack is set up once.
MeasureRequest request_for(const std::vector<BispectralGeometry>& geometries) {
    std::vector<double> theta_i, theta_o, phi;
    for (const BispectralGeometry& geometry : geometries) {
        theta_i.push_back(geometry.theta_i_deg);
        theta_o.push_back(geometry.theta_o_deg);
        phi.push_back(geometry.phi_deg);
    }
    MeasureRequest request;
    request.theta_i_deg = each_once(std::move(theta_i));
    request.theta_o_deg = each_once(std::move(theta_o));
    request.phi_deg = each_once(std::move(phi));
    request.model = Model::Adding;
    return request;
}

/// Light of the substrate is what is looked for. That of dyes in layers goes with it, since no
/// instrument tells the two apart.
bool is_seen(MeasuredPart part, const LayerStack& stack) {
    return part == MeasuredPart::Diffuse || (stack.is_dyed() && part != MeasuredPart::Specular);
}

/// The substrate in every geometry on one grid for both axes; without geometries the bare one.
std::vector<Eigen::MatrixXd> on_common_grid(const SynthRecipe& recipe,
                                            const WavelengthGrid& bands) {
    const Eigen::MatrixXd bare =
        matrix_from_fluorophores(recipe.fluorophores, recipe.reflectance, bands, bands).values;
    const std::vector<BispectralGeometry>& geometries = recipe.geometries;
    if (geometries.empty())
        return {bare};
    std::vector<Eigen::MatrixXd> seen(geometries.size(),
                                      Eigen::MatrixXd::Zero(bands.count, bands.count));
    LayerStack stack = recipe.stack;
    join_layers({&stack});
    const Measurement measurement = measure_stack(stack, bare, bands, request_for(geometries));
    for (const MeasureRow& row : measurement.rows) {
        const auto found =
            std::find(geometries.begin(), geometries.end(),
                      BispectralGeometry{row.theta_i_deg, row.theta_o_deg, row.phi_deg});
        if (is_seen(row.part, recipe.stack) && found != geometries.end())
            seen[static_cast<std::size_t>(found - geometries.begin())](
                bands.band_of(row.lambda_o_nm), bands.band_of(row.lambda_i_nm)) +=
                std::numbers::pi * row.value;
    }
    return seen;
}

/// The part of a matrix on a common grid that the recipe's grids hold.
Eigen::MatrixXd cut(const Eigen::MatrixXd& values, const WavelengthGrid& bands,
                    const SynthRecipe& recipe) {
    return values.block(bands.band_of(recipe.emission.centre_nm(0)),
                        bands.band_of(recipe.excitation.centre_nm(0)), recipe.emission.count,
                        recipe.excitation.count);
}

/// `Bandpasses` gives what the two bandpasses see of a fine matrix. Fluorescence is smoothed along
/// both axes. The reflectance is that of the light which both let through: an instrument is
/// calibrated on a white diffuser, and its overlap beside the diagonal is what `spill` says.
class Bandpasses {
public:
    Bandpasses(const SynthRecipe& recipe, const WavelengthGrid& fine)
        : recipe_(recipe), fine_(fine),
          emission_(bandpass(recipe.emission, fine, recipe.instrument.emission_fwhm_nm)),
          excitation_(bandpass(recipe.excitation, fine, recipe.instrument.excitation_fwhm_nm)) {}

    Eigen::MatrixXd see(const Eigen::MatrixXd& values) const {
        const Eigen::VectorXd reflectance = values.diagonal();
        Eigen::MatrixXd fluorescence = values;
        fluorescence.diagonal().setZero();
        Eigen::MatrixXd seen = emission_ * fluorescence * excitation_.transpose() *
                               (recipe_.excitation.step_nm / fine_.step_nm);
        const ReradiationMatrix shape{recipe_.emission, recipe_.excitation, seen};
        for (int i = 0; i < recipe_.excitation.count; ++i)
            if (const int o = diagonal_row(shape, i); o >= 0) {
                const Eigen::VectorXd both =
                    emission_.row(o).cwiseProduct(excitation_.row(i)).transpose();
                seen(o, i) += both.dot(reflectance) / both.sum();
            }
        return seen;
    }

private:
    const SynthRecipe& recipe_;
    const WavelengthGrid& fine_;
    Eigen::MatrixXd emission_, excitation_;
};

} // namespace

ReradiationMatrix synth_truth(const SynthRecipe& recipe) {
    return matrix_from_fluorophores(recipe.fluorophores, recipe.reflectance, recipe.emission,
                                    recipe.excitation);
}

std::vector<Eigen::MatrixXd> synth_noise_free(const SynthRecipe& recipe) {
    if (!has_bandpass(recipe.instrument) && recipe.geometries.empty())
        return {synth_truth(recipe).values};
    const bool fine = has_bandpass(recipe.instrument);
    const WavelengthGrid bands =
        fine ? fine_grid(recipe) : union_of(recipe.emission, recipe.excitation);
    std::vector<Eigen::MatrixXd> seen = on_common_grid(recipe, bands);
    const Bandpasses bandpasses(recipe, bands);
    for (Eigen::MatrixXd& values : seen)
        values = fine ? bandpasses.see(values) : cut(values, bands, recipe);
    return seen;
}

void add_spill(const SynthRecipe& recipe, Eigen::MatrixXd& values) {
    const ReradiationMatrix shape{recipe.emission, recipe.excitation, values};
    for (int i = 0; i < recipe.excitation.count; ++i) {
        const int o = diagonal_row(shape, i);
        if (o < 0)
            continue;
        for (const int beside : {o - 1, o + 1})
            if (beside >= 0 && beside < recipe.emission.count)
                values(beside, i) += recipe.instrument.spill * shape.values(o, i);
        const int twice = recipe.emission.band_of(2.0 * recipe.excitation.centre_nm(i));
        if (twice >= 0)
            values(twice, i) += recipe.instrument.second_order * shape.values(o, i);
    }
}

} // namespace reradiant
