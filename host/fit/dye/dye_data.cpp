#include "host/fit/dye/dye_data.h"

#include "host/fit/data/fit_mask.h"
#include "host/fit/data/fit_target.h"
#include "host/fit/data/noise_estimate.h"
#include "host/fit/data/prepared_target.h"
#include "host/measure/geometry_matrix.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;

AirDirection direction_of(double theta_deg) {
    return {std::fabs(std::cos(theta_deg * std::numbers::pi / 180.0)),
            theta_deg < 90.0 ? Side::Above : Side::Below};
}

DyeView view_of(const BispectralBlock& block, const BispectralData& data) {
    if (block.geometry) {
        const AirDirection out = direction_of(block.geometry->theta_o_deg);
        return {direction_of(block.geometry->theta_i_deg), out.side, out.cosine};
    }
    constexpr const char* remedy =
        "add a line `# geometry: 45/0` (or 8/d) or give the CSV of `measure`";
    ViewingGeometry geometry;
    try {
        geometry = viewing_geometry(data.geometry);
    } catch (const std::invalid_argument&) {
        throw_input_error({data.file.string()},
                          "the data do not say from where light came and from where it was seen",
                          remedy);
    }
    const AirDirection from = direction_of(geometry.theta_i_deg);
    switch (geometry.kind) {
    case ViewingGeometry::Kind::Directional: {
        const AirDirection out = direction_of(geometry.theta_o_deg);
        return {from, out.side, out.cosine};
    }
    case ViewingGeometry::Kind::DirectionalHemispherical:
        return {from, from.side, std::nullopt};
    case ViewingGeometry::Kind::HemisphericalDirectional:
        break;
    }
    throw_input_error({data.file.string()}, "the data are of light that comes from all sides",
                      remedy);
}

/// Readings that a full detector makes: from the ceiling up, or, without one, a plateau.
Matrix saturated_in(const Matrix& value, const Matrix& used, std::optional<double> ceiling) {
    constexpr double rounding = 1e-6;
    const Matrix seen = (used.array() > 0.0).select(value, 0.0);
    if (ceiling)
        return (seen.array() >= (1.0 - rounding) * *ceiling).cast<double>();
    return saturated_entries(seen);
}

/// Reflected light is brighter than fluorescence, and estimates from that do not see its noise.
void take_noise_of_diagonal(const Matrix& value, const Matrix& diagonal, Matrix& sigma) {
    constexpr double clearly = 1.5; // an estimate from 20 differences is uncertain by a fifth
    std::vector<double> list;
    for (Eigen::Index k = 0; k < value.size(); ++k)
        if (diagonal(k) > 0.0)
            list.push_back(value(k));
    if (list.empty())
        return;
    const double noise = estimated_curve_noise(
        Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
    for (Eigen::Index k = 0; k < value.size(); ++k)
        if (diagonal(k) > 0.0 && noise > clearly * sigma(k))
            sigma(k) = noise;
}

struct EntrySets {
    Matrix off, diagonal; ///< 1 where entries above the spilled diagonal, and on it, may be used
};

EntrySets entries_of(const BispectralData& data, double spill_nm) {
    EntrySets sets{Matrix::Zero(data.emission.count, data.excitation.count), {}};
    sets.diagonal = sets.off;
    for (int i = 0; i < data.excitation.count; ++i)
        for (int o = 0; o < data.emission.count; ++o) {
            const double shift = data.emission.centre_nm(o) - data.excitation.centre_nm(i);
            if (on_diagonal(data.emission, o, data.excitation, i))
                sets.diagonal(o, i) = 1.0;
            else if (shift > spill_nm + 1e-6 * data.emission.step_nm)
                sets.off(o, i) = 1.0;
        }
    return sets;
}

} // namespace

Eigen::Index DyeDataSet::used_count() const {
    Eigen::Index count = 0;
    for (const DyeBlock& block : blocks)
        count += (block.weight.array() > 0.0).count();
    return count;
}

std::vector<DyeView> views_of(const BispectralData& data) {
    std::vector<DyeView> views;
    for (const BispectralBlock& block : data.blocks)
        views.push_back(view_of(block, data));
    return views;
}

DyeDataSet prepare_dye_data(const BispectralData& data, const DyeFitSettings& settings,
                            bool with_diagonal) {
    DyeDataSet set;
    const double spill_nm = settings.spill_nm.value_or(data.emission.step_nm);
    set.mask = mask_of(data, settings.mask, {spill_nm, false});
    set.data = with_gaps(data, set.mask);
    set.views = views_of(data);
    set.notes = set.mask.notes;
    set.noise_is_estimated = true;
    const EntrySets entries = entries_of(data, spill_nm);
    for (std::size_t b = 0; b < data.blocks.size(); ++b) {
        const BispectralBlock& block = set.data.blocks[b];
        const Matrix known = (block.value.array() == block.value.array()).cast<double>();
        Matrix used = entries.off.cwiseProduct(known);
        const Matrix full = saturated_in(block.value, used, settings.ceiling);
        set.saturated += static_cast<int>(full.sum());
        used -= full;
        const EntryErrors errors = entry_errors(block.value, block.sigma, used);
        Matrix sigma = errors.sigma;
        if (with_diagonal && set.views[b].cosine) {
            Matrix diagonal = entries.diagonal.cwiseProduct(known);
            diagonal -= saturated_in(block.value, diagonal, settings.ceiling);
            if (errors.is_estimated)
                take_noise_of_diagonal(block.value, diagonal, sigma);
            used += diagonal;
        }
        set.noise_is_estimated = set.noise_is_estimated && errors.is_estimated;
        set.noise = std::max(set.noise, errors.noise);
        set.notes.insert(set.notes.end(), errors.notes.begin(), errors.notes.end());
        set.blocks.push_back({(used.array() > 0.0).select(errors.value, 0.0),
                              (used.array() > 0.0).select(sigma.cwiseInverse(), 0.0)});
    }
    if (set.saturated > 0)
        set.notes.push_back(fmt::format("{} saturated entries were left out", set.saturated));
    if (set.used_count() == 0)
        throw_input_error({data.file.string()},
                          "no entry is left to fit: all are masked, saturated, not measured or "
                          "below the excitation",
                          "give narrower --mask rules, or data of emission above the excitation");
    return set;
}

} // namespace reradiant
