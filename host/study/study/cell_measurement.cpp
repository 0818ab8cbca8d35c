#include "host/study/study/cell_measurement.h"

#include "reradiant/colour.h"

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
    const Eigen::VectorXd light = on_bands(illuminant.spectrum, bands);
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
    colour.lab = xyz_to_lab(colour.xyz, white_100);
    for (int band = 0; band < bands.count; ++band)
        colour.beta_t.push_back(light(band) > 0.0 ? radiance(band) / light(band) : not_a_number);
    return colour;
}

double quantum_yield(const CellMeasurement& cell, const Spectrum& illuminant) {
    const int n = cell.bands.count;
    const Eigen::VectorXd light = on_bands(illuminant, cell.bands);
    std::vector<double> emitted(static_cast<std::size_t>(n), 0.0);
    for (int i = 0; i < n; ++i)
        for (int o = 0; o < n; ++o)
            if (o != i)
                emitted[static_cast<std::size_t>(i)] +=
                    cell.matrix(o, i) * cell.bands.centre_nm(o) / cell.bands.centre_nm(i);
    const double strongest = *std::max_element(emitted.begin(), emitted.end());
    double out = 0.0, in = 0.0;
    for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!(emitted[k] > least_excitation * strongest))
            continue;
        const double photons = light(i) * cell.bands.centre_nm(i);
        out += photons * emitted[k];
        in += photons * (1.0 - cell.matrix(i, i) - cell.specular[k]);
    }
    return in > 0.0 ? out / in : not_a_number;
}

void measure_hemispherical(const Material& material, MeasureRequest request,
                           CellMeasurement& cell) {
    request.hemispherical = true;
    request.theta_i_deg = {request.theta_i_deg.front()};
    const Measurement measurement = measure_material(material, request);
    const DirectionalMatrix matrix = by_directions(measurement).begin()->second;
    cell.bands = measurement.bands;
    cell.matrix = matrix.diffuse;
    cell.specular.assign(matrix.specular.begin(), matrix.specular.end());
}

PolarCurve polar_curve(const std::map<Directions, DirectionalMatrix>& matrices, double theta_i,
                       const NamedIlluminant& illuminant, const WavelengthGrid& bands) {
    const std::vector<Xyz> weights = xyz_weights(bands);
    const Eigen::VectorXd light = on_bands(illuminant.spectrum, bands);
    const double white = weighted(light, weights)[1];
    PolarCurve curve{theta_i, {}, {}, {}};
    for (double angle = -polar_limit_deg; angle <= polar_limit_deg; angle += polar_step_deg) {
        const DirectionalMatrix& matrix =
            matrices.at({theta_i, std::abs(angle), angle < 0.0 ? 0.0 : 180.0});
        curve.angle_deg.push_back(angle);
        curve.diffuse.push_back(weighted(std::numbers::pi * (matrix.diffuse * light), weights)[1] /
                                white);
        curve.total.push_back(weighted(factor_times_light(matrix, light), weights)[1] / white);
    }
    return curve;
}

std::vector<double> polar_angles() {
    std::vector<double> angles;
    for (double angle = 0.0; angle <= polar_limit_deg; angle += polar_step_deg)
        angles.push_back(angle);
    return angles;
}

} // namespace

CellMeasurement measure_cell(const Material& material, const StudyMeasuring& measuring,
                             const std::vector<NamedIlluminant>& illuminants) {
    refuse_measured_sheet(material, material.position);
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
            cell.colours.back().quantum_yield = quantum_yield(cell, illuminant.spectrum);
        }

    request.theta_o_deg = polar_angles();
    request.phi_deg = {0.0, 180.0};
    const auto plane = by_directions(measure_material(material, request));
    for (const double theta_i : measuring.theta_i_deg)
        cell.polar.push_back(polar_curve(plane, theta_i, illuminants.front(), cell.bands));
    return cell;
}

} // namespace reradiant
