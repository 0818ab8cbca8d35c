#include "reradiant/measure.h"

#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/directions.h"
#include "host/measure/measure_memory.h"
#include "host/measure/measure_substrate.h"
#include "host/measure/row_writer.h"
#include "host/measure/walk_measurement.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/model_choice.h"
#include "host/scene/model/substrate.h"
#include "reradiant/error.h"
#include "reradiant/reradiation.h"

#include <Eigen/Core>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace reradiant {

namespace {

void check_angles(const std::vector<double>& angles, const char* name, const char* remedy,
                  const std::function<bool(double)>& is_good) {
    if (angles.empty())
        throw_input_error({}, fmt::format("{} holds no angle", name), remedy);
    for (const double angle : angles)
        if (!is_good(angle))
            throw_input_error({}, fmt::format("{} of {} degrees is out of range", name, angle),
                              remedy);
}

void check_polar_angles(const std::vector<double>& angles, const char* name, bool of_sheet) {
    if (of_sheet)
        return check_angles(angles, name,
                            "angles from the normal lie between 0 and 180 degrees, and 90 is along "
                            "the sheet",
                            [](double a) { return a >= 0.0 && a <= 180.0 && a != 90.0; });
    for (const double angle : angles)
        if (angle > 90.0 && angle <= 180.0)
            throw_input_error({},
                              fmt::format("{} of {} degrees lies beneath the material, which is "
                                          "opaque",
                                          name, angle),
                              "angles from the normal lie between 0 and below 90 degrees; a sheet "
                              "(substrate type \"none\") has two sides");
    check_angles(angles, name, "angles from the normal lie between 0 and below 90 degrees",
                 [](double a) { return a >= 0.0 && a < 90.0; });
}

void check_request(const MeasureRequest& request, bool of_sheet) {
    check_polar_angles(request.theta_i_deg, "theta-i", of_sheet);
    if (request.hemispherical)
        return;
    check_polar_angles(request.theta_o_deg, "theta-o", of_sheet);
    check_angles(request.phi_deg, "phi", "azimuths lie between -360 and 360 degrees",
                 [](double a) { return a >= -360.0 && a <= 360.0; });
}

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

Eigen::VectorXd by_band(const LayeredBsdf& surface, int bands, const auto& value) {
    Eigen::VectorXd values(bands);
    for (int band = 0; band < bands; ++band)
        values(band) = value(surface.at(band));
    return values;
}

void add_directional(RowWriter& rows, const LayeredBsdf& surface, const MeasureRow& angles,
                     int bands) {
    const kernels::Vec3 wi = direction_at(std::cos(radians(angles.theta_i_deg)), 0.0);
    const kernels::Vec3 wo =
        direction_at(std::cos(radians(angles.theta_o_deg)), radians(angles.phi_deg));
    rows.add(angles, MeasuredPart::Diffuse, surface.diffuse(wi, wo));
    rows.add(angles, MeasuredPart::Specular,
             by_band(surface, bands, [&](const StackBsdf& at) { return at.specular(wi, wo); }));
}

void add_hemispherical(RowWriter& rows, const LayeredBsdf& surface, double theta_i, int bands) {
    const double c = std::cos(radians(theta_i));
    rows.add(rows_at(theta_i), MeasuredPart::Diffuse, surface.diffuse_albedo(c));
    rows.add(rows_at(theta_i), MeasuredPart::Specular,
             by_band(surface, bands, [&](const StackBsdf& at) { return at.specular_albedo(c); }));
}

void add_notes(Measurement& measurement, const LayeredBsdf& surface,
               const MeasureRequest& request) {
    double delta = 0.0, lost = 0.0;
    for (const double theta : request.theta_i_deg) {
        for (int band = 0; band < measurement.bands.count; ++band) {
            const double c = std::cos(radians(theta));
            delta = std::max(delta, surface.at(band).delta(c));
            lost = std::max(lost, surface.at(band).lost(c));
        }
    }
    if (delta > 0.0) {
        measurement.notes.push_back(
            request.hemispherical
                ? "the rows include the mirror reflection of smooth surfaces"
                : fmt::format("the mirror reflection of smooth surfaces (weight up to {:.9g}) is "
                              "a delta and left out of these directional rows",
                              delta));
    }
    if (lost > 0.0) {
        measurement.notes.push_back(fmt::format(
            "scattering = \"single\" loses up to {:.6g} of the incident flux between facets",
            lost));
    }
}

} // namespace

WavelengthGrid measured_bands(const Material& material, const MeasureRequest& request) {
    if (request.bands)
        return *request.bands;
    if (const auto own = material.substrate.own_grid())
        return *own;
    if (material.substrate.matrix) {
        throw_input_error({},
                          "the matrix's emission and excitation wavelengths share no common grid",
                          "name the bands to measure on: --bands FROM:TO:STEP");
    }
    for (const Layer& layer : material.stack.layers)
        for (const SlabDye& dye : layer.dyes)
            if (dye.shares && dye.shares->emission == dye.shares->excitation)
                return dye.shares->emission;
    return grid_from_range(material.is_fluorescent() ? 300.0 : 380.0, 780.0, 10.0);
}

Measurement measure_substrate(const LayerStack& stack, const SubstrateValues& substrate,
                              const WavelengthGrid& bands, const MeasureRequest& request) {
    check_request(request, stack.is_sheet());
    if (request.model == Model::Walk)
        return measure_by_walk(stack, substrate, bands, request);
    Measurement measurement;
    measurement.bands = bands;
    measurement.hemispherical = request.hemispherical;
    measurement.of_sheet = stack.is_sheet();
    measurement.model = request.model == Model::Auto ? Model::Adding : request.model;
    const LayeredBsdf surface(stack, substrate, bands, closed_model(measurement.model));
    RowWriter rows(measurement, possible_pairs({surface.coupling()}, bands.count, false));
    for (const double theta_i : request.theta_i_deg) {
        throw_if_stopped(request.stop);
        if (request.hemispherical) {
            add_hemispherical(rows, surface, theta_i, bands.count);
            continue;
        }
        for (const double theta_o : request.theta_o_deg)
            for (const double phi : request.phi_deg)
                add_directional(rows, surface, rows_at(theta_i, theta_o, phi), bands.count);
    }
    add_notes(measurement, surface, request);
    return measurement;
}

Measurement measure_stack(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                          const WavelengthGrid& bands, const MeasureRequest& request) {
    return measure_substrate(stack, {per_band, 0.0, {}}, bands, request);
}

SubstrateValues measured_substrate(const Substrate& substrate, const WavelengthGrid& bands) {
    SubstrateValues measured;
    if (substrate.type == SubstrateType::None) {
        measured.matrix = Eigen::MatrixXd::Zero(bands.count, bands.count);
        return measured;
    }
    if (substrate.type == SubstrateType::Conductor) {
        for (const double nm : bands.centres_nm())
            measured.conductor.push_back(conductor_at(substrate.conductor, nm));
        return measured;
    }
    measured.sigma = substrate.type == SubstrateType::OrenNayar ? substrate.sigma : 0.0;
    measured.matrix = fluorescence_of(substrate, bands);
    for (int band = 0; band < bands.count; ++band)
        measured.matrix(band, band) += substrate.reflectance(bands.centre_nm(band));
    return measured;
}

Measurement measure_material(const Material& material, const MeasureRequest& request) {
    MeasureRequest resolved = request;
    const ModelChoice choice = choose_model(material, request.model, ModelUse::Measure);
    resolved.model = choice.model;
    check_request(resolved, material.stack.is_sheet());
    const WavelengthGrid bands = measured_bands(material, request);
    check_measure_memory(material, bands, request);
    Measurement measurement = measure_substrate(
        material.stack, measured_substrate(material.substrate, bands), bands, resolved);
    if (!choice.reason.empty())
        measurement.notes.insert(measurement.notes.begin(), choice.reason);
    return measurement;
}

} // namespace reradiant
