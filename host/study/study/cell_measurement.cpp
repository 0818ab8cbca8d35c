#include "host/study/study/cell_measurement.h"

#include "host/spectral/colour/lamp.h"
#include "reradiant/colour.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>

namespace reradiant {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double polar_limit_deg = 85.0, polar_step_deg = 2.5;
/// Bands that excite less than this share of the strongest do not count for the yield: there, what
/// is absorbed is the substrate's business alone.
constexpr double least_excitation = 0.01;

/// Radiance of every band for unit irradiance spectrum E, in two parts, of one pair of directions.
struct DirectionalMatrix {
    Eigen::MatrixXd diffuse;  ///< 1/sr, rows = emission; of the substrate and of slabs
    Eigen::VectorXd specular; ///< 1/sr
};
using Directions = std::tuple<double, double, double>; ///< theta_i, theta_o, phi

std::map<Directions, DirectionalMatrix> by_directions(const Measurement& measurement) {
    const int n = measurement.bands.count;
    std::map<Directions, DirectionalMatrix> result;
    for (const MeasureRow& row : measurement.rows) {
        DirectionalMatrix& entry = result[{row.theta_i_deg, row.theta_o_deg, row.phi_deg}];
        if (entry.diffuse.size() == 0) {
            entry.diffuse = Eigen::MatrixXd::Zero(n, n);
            entry.specular = Eigen::VectorXd::Zero(n);
        }
        const int o = measurement.bands.band_of(row.lambda_o_nm);
        const int i = measurement.bands.band_of(row.lambda_i_nm);
        if (row.part == MeasuredPart::Specular)
            entry.specular(o) = row.value;
        else if (is_reflected(row.part))
            entry.diffuse(o, i) += row.value; // of the substrate and of slabs
    }
    return result;
}

/// Means over the bands: a lamp's line counts wherever in its band it lies.
Eigen::VectorXd on_bands(const Spectrum& spectrum, const WavelengthGrid& bands) {
    Eigen::VectorXd values(bands.count);
    for (int band = 0; band < bands.count; ++band)
        values(band) = spectrum.average(bands.lower_edge_nm(band), bands.upper_edge_nm(band));
    return values;
}

/// A lamp's light by band, and whether a white surface under it is seen at all: what is relative to
/// that is meaningless where it is not, as under an ultraviolet lamp alone.
struct LightOnBands {
    Eigen::VectorXd values;
    bool shows_white = true;
    double dark = 0.0; ///< a band with less is taken as dark
};

LightOnBands light_on_bands(const NamedIlluminant& illuminant, const WavelengthGrid& bands) {
    /// Tails of a Gaussian, say, which no instrument could measure a factor by.
    constexpr double least_share = 1e-6;
    LightOnBands light{on_bands(illuminant.spectrum, bands), true, 0.0};
    light.dark = least_share * light.values.maxCoeff();
    light.shows_white = light.values.maxCoeff() > 0.0 &&
                        faint_white_warning({.name = illuminant.name, .light = illuminant.spectrum},
                                            Observer::Cie1931Deg2)
                            .empty();
    return light;
}

Xyz weighted(const Eigen::VectorXd& radiance, const std::vector<Xyz>& weights) {
    Xyz xyz{};
    for (std::size_t band = 0; band < weights.size(); ++band)
        for (std::size_t channel = 0; channel < 3; ++channel)
            xyz[channel] += weights[band][channel] * radiance(static_cast<Eigen::Index>(band));
    return xyz;
}

/// Returns the radiance under a light over that of a perfect diffuser for unit irradiance, which is
/// 1/pi.
Eigen::VectorXd factor_times_light(const DirectionalMatrix& matrix, const Eigen::VectorXd& light) {
    return std::numbers::pi * (matrix.diffuse * light + matrix.specular.cwiseProduct(light)).eval();
}

SeenColour seen(const Directions& directions, const DirectionalMatrix& matrix,
                const NamedIlluminant& illuminant, const WavelengthGrid& bands) {
    const std::vector<Xyz> weights = xyz_weights(bands);
    const LightOnBands lamp = light_on_bands(illuminant, bands);
    const Eigen::VectorXd& light = lamp.values;
    const Eigen::VectorXd radiance = factor_times_light(matrix, light);
    SeenColour colour{illuminant.name,
                      std::get<0>(directions),
                      std::get<1>(directions),
                      std::get<2>(directions),
                      {},
                      {},
                      {},
                      not_a_number};
    const Xyz white = weighted(light, weights), sample = weighted(radiance, weights);
    Xyz white_100{};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        colour.xyz[channel] = 100.0 * sample[channel] / white[1];
        white_100[channel] = 100.0 * white[channel] / white[1];
    }
    if (lamp.shows_white)
        colour.lab = xyz_to_lab(colour.xyz, white_100);
    else
        colour.xyz = colour.lab = {not_a_number, not_a_number, not_a_number};
    for (int band = 0; band < bands.count; ++band)
        colour.beta_t.push_back(light(band) > lamp.dark ? radiance(band) / light(band)
                                                        : not_a_number);
    return colour;
}

/// Photons that leave in other bands over those that do not leave as they came.
double quantum_yield(const CellMeasurement& cell, const Spectrum& illuminant) {
    const int n = cell.bands.count;
    const Eigen::VectorXd light = on_bands(illuminant, cell.bands);
    Eigen::MatrixXd leaving = cell.matrix;
    if (cell.of_sheet())
        leaving += cell.transmitted;
    std::vector<double> emitted(static_cast<std::size_t>(n), 0.0);
    for (int i = 0; i < n; ++i)
        for (int o = 0; o < n; ++o)
            if (o != i)
                emitted[static_cast<std::size_t>(i)] +=
                    leaving(o, i) * cell.bands.centre_nm(o) / cell.bands.centre_nm(i);
    const double strongest = *std::max_element(emitted.begin(), emitted.end());
    double out = 0.0, in = 0.0;
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!(emitted[k] > least_excitation * strongest))
            continue;
        const double photons = light(i) * cell.bands.centre_nm(i);
        const double straight = cell.of_sheet() ? cell.straight[k] : 0.0;
        out += photons * emitted[k];
        in += photons * (1.0 - leaving(i, i) - cell.specular[k] - straight);
    }
    return in > 0.0 ? out / in : not_a_number;
}

/// Luminous flux that a matrix and a diagonal make of a lamp's; that of the lamp is 100.
double luminous_share(const Eigen::MatrixXd& matrix, const std::vector<double>& diagonal,
                      const NamedIlluminant& illuminant, const WavelengthGrid& bands) {
    const std::vector<Xyz> weights = xyz_weights(bands);
    const LightOnBands lamp = light_on_bands(illuminant, bands);
    if (!lamp.shows_white)
        return not_a_number;
    const Eigen::VectorXd& light = lamp.values;
    Eigen::VectorXd leaving = matrix * light;
    for (std::size_t band = 0; band < diagonal.size(); ++band) {
        const auto k = static_cast<Eigen::Index>(band);
        leaving(k) += diagonal[band] * light(k);
    }
    return 100.0 * weighted(leaving, weights)[1] / weighted(light, weights)[1];
}

void add_whole_sample(SeenColour& colour, const CellMeasurement& cell,
                      const NamedIlluminant& lamp) {
    colour.quantum_yield = quantum_yield(cell, lamp.spectrum);
    colour.reflected = luminous_share(cell.matrix, cell.specular, lamp, cell.bands);
    if (!cell.of_sheet())
        return;
    colour.transmitted = luminous_share(cell.transmitted, cell.straight, lamp, cell.bands);
    colour.guided = luminous_share(cell.guided, {}, lamp, cell.bands);
}

void add_hemispherical(const MeasureRow& row, CellMeasurement& cell) {
    const int o = cell.bands.band_of(row.lambda_o_nm), i = cell.bands.band_of(row.lambda_i_nm);
    switch (row.part) {
    case MeasuredPart::Specular:
        cell.specular[static_cast<std::size_t>(o)] += row.value;
        return;
    case MeasuredPart::TransmittedSpecular:
        cell.straight[static_cast<std::size_t>(o)] += row.value;
        return;
    case MeasuredPart::Transmitted:
        cell.transmitted(o, i) += row.value;
        return;
    case MeasuredPart::Guided:
        cell.guided(o, i) += row.value;
        return;
    case MeasuredPart::Diffuse:
    case MeasuredPart::Slab:
        cell.matrix(o, i) += row.value;
    }
}

void measure_hemispherical(const Material& material, MeasureRequest request,
                           CellMeasurement& cell) {
    request.hemispherical = true;
    request.theta_i_deg = {request.theta_i_deg.front()};
    const Measurement measurement = measure_material(material, request);
    const int n = measurement.bands.count;
    cell.bands = measurement.bands;
    cell.matrix = Eigen::MatrixXd::Zero(n, n);
    cell.specular.assign(static_cast<std::size_t>(n), 0.0);
    if (measurement.of_sheet) {
        cell.transmitted = cell.guided = cell.matrix;
        cell.straight = cell.specular;
    }
    for (const MeasureRow& row : measurement.rows)
        add_hemispherical(row, cell);
}

PolarCurve polar_curve(const std::map<Directions, DirectionalMatrix>& matrices, double theta_i,
                       const std::vector<double>& angles, const NamedIlluminant& illuminant,
                       const WavelengthGrid& bands) {
    const std::vector<Xyz> weights = xyz_weights(bands);
    const LightOnBands lamp = light_on_bands(illuminant, bands);
    const Eigen::VectorXd& light = lamp.values;
    const double white = lamp.shows_white ? weighted(light, weights)[1] : not_a_number;
    PolarCurve curve{theta_i, {}, {}, {}};
    for (const double angle : angles) {
        curve.angle_deg.push_back(angle);
        if (std::isnan(angle)) {
            curve.diffuse.push_back(not_a_number);
            curve.total.push_back(not_a_number);
            continue;
        }
        const DirectionalMatrix& matrix =
            matrices.at({theta_i, std::abs(angle), angle < 0.0 ? 0.0 : 180.0});
        curve.diffuse.push_back(weighted(std::numbers::pi * (matrix.diffuse * light), weights)[1] /
                                white);
        curve.total.push_back(weighted(factor_times_light(matrix, light), weights)[1] / white);
    }
    return curve;
}

/// Angles of a polar curve, from the light's side to the mirror's; NaN keeps both sides of a sheet
/// apart.
std::vector<double> polar_angles(bool of_sheet) {
    std::vector<double> angles;
    if (of_sheet) {
        for (double angle = -180.0; angle <= polar_limit_deg - 180.0; angle += polar_step_deg)
            angles.push_back(angle);
        angles.push_back(not_a_number);
    }
    for (double angle = -polar_limit_deg; angle <= polar_limit_deg; angle += polar_step_deg)
        angles.push_back(angle);
    if (of_sheet) {
        angles.push_back(not_a_number);
        for (double angle = 180.0 - polar_limit_deg; angle <= 180.0; angle += polar_step_deg)
            angles.push_back(angle);
    }
    return angles;
}

/// Polar angles that are looked at for a curve.
std::vector<double> thetas_of(const std::vector<double>& angles) {
    std::vector<double> thetas;
    for (const double angle : angles)
        if (angle >= 0.0)
            thetas.push_back(angle);
    return thetas;
}

} // namespace

CellMeasurement measure_cell(const Material& material, const StudyMeasuring& measuring,
                             const std::vector<NamedIlluminant>& illuminants) {
    CellMeasurement cell;
    MeasureRequest request;
    request.model = measuring.model;
    request.samples = measuring.samples;
    request.theta_i_deg = measuring.theta_i_deg;
    measure_hemispherical(material, request, cell);

    request.theta_o_deg = measuring.theta_o_deg;
    request.phi_deg = measuring.phi_deg;
    const Measurement directional = measure_material(material, request);
    cell.notes = directional.notes;
    for (const auto& [directions, matrix] : by_directions(directional))
        for (const NamedIlluminant& illuminant : illuminants) {
            cell.colours.push_back(seen(directions, matrix, illuminant, cell.bands));
            add_whole_sample(cell.colours.back(), cell, illuminant);
        }

    for (const NamedIlluminant& illuminant : illuminants)
        if (!light_on_bands(illuminant, cell.bands).shows_white)
            cell.notes.push_back(fmt::format(
                "{}: a white surface is all but dark under this lamp, so that XYZ, Lab, luminous "
                "flux and polar curves, which are relative to it, are left out",
                illuminant.name));

    const std::vector<double> angles = polar_angles(cell.of_sheet());
    request.theta_o_deg = thetas_of(angles);
    request.phi_deg = {0.0, 180.0};
    const auto plane = by_directions(measure_material(material, request));
    for (const double theta_i : measuring.theta_i_deg)
        cell.polar.push_back(polar_curve(plane, theta_i, angles, illuminants.front(), cell.bands));
    return cell;
}

} // namespace reradiant
