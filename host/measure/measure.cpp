#include "reradiant/measure.h"

#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/directions.h"
#include "host/measure/measure_memory.h"
#include "host/measure/measure_substrate.h"
#include "host/measure/row_writer.h"
#include "host/measure/walk_measurement.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/matrix_grids.h"
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

/// Light that slabs spread keeps its band where they hold no dyes.
PartValues values_of(const LayeredBsdf& surface, const LayeredBsdf::Parts& parts) {
    if (surface.emitting())
        return {parts.diffuse, parts.slab, parts.specular};
    return {parts.diffuse, parts.slab.diagonal(), parts.specular};
}

AirDirection from(double theta_deg) {
    return {std::fabs(std::cos(radians(theta_deg))), theta_deg < 90.0 ? Side::Above : Side::Below};
}

void add_directional(PartRows& rows, const LayeredBsdf& surface, const MeasureRow& angles) {
    const kernels::Vec3 wi = direction_at(std::cos(radians(angles.theta_i_deg)), 0.0);
    const kernels::Vec3 wo =
        direction_at(std::cos(radians(angles.theta_o_deg)), radians(angles.phi_deg));
    rows.add_reflected(angles, values_of(surface, surface.parts(wi, wo)));
}

void add_hemispherical(PartRows& rows, const LayeredBsdf& surface, double theta_i) {
    const MeasureRow angles = rows_at(theta_i);
    const AirDirection wi = from(theta_i);
    rows.add_reflected(angles, values_of(surface, surface.albedo(wi, wi.side)));
    if (!surface.is_sheet())
        return;
    const Side far = wi.side == Side::Above ? Side::Below : Side::Above;
    rows.add_transmitted(angles, values_of(surface, surface.albedo(wi, far)));
    rows.add_guided(angles, surface.guided(wi));
}

/// The largest shares of the incident light that are not where one may look for them.
struct Remarks {
    double delta = 0.0, straight_on = 0.0, lost = 0.0;

    void add(const LayeredBsdf& surface, double theta_deg) {
        const AirDirection wi = from(theta_deg);
        delta = std::max(delta, surface.delta(wi.cosine, wi.side).maxCoeff());
        if (surface.is_sheet())
            straight_on = std::max(straight_on, surface.straight_on(wi.cosine).maxCoeff());
        for (int band = 0; band < surface.bands(); ++band)
            lost = std::max(lost, surface.at(band).lost(wi.cosine));
    }
};

std::string note_of_deltas(const Remarks& remarks, bool hemispherical) {
    if (hemispherical)
        return "the rows include the mirror reflection of smooth surfaces";
    if (!(remarks.straight_on > 0.0))
        return fmt::format("the mirror reflection of smooth surfaces (weight up to {:.9g}) is a "
                           "delta and left out of these directional rows",
                           remarks.delta);
    return fmt::format("the mirror reflection of smooth surfaces (weight up to {:.9g}) and what "
                       "passes them straight on ({:.9g}) are deltas and left out of these "
                       "directional rows",
                       remarks.delta, remarks.straight_on);
}

void add_notes(Measurement& measurement, const LayeredBsdf& surface,
               const MeasureRequest& request) {
    Remarks remarks;
    for (const double theta : request.theta_i_deg)
        remarks.add(surface, theta);
    if (remarks.delta > 0.0 || remarks.straight_on > 0.0)
        measurement.notes.push_back(note_of_deltas(remarks, request.hemispherical));
    if (remarks.lost > 0.0)
        measurement.notes.push_back(fmt::format(
            "scattering = \"single\" loses up to {:.6g} of the incident flux between facets",
            remarks.lost));
    if (const EmittingStack* dyes = surface.emitting())
        measurement.notes.push_back(
            fmt::format("what dyes send out is found in {} cells of depth; the last halving of "
                        "them changed shares by {:.1e} of the largest",
                        dyes->cells(), dyes->error()));
}

} // namespace

WavelengthGrid measured_bands(const Material& material, const MeasureRequest& request) {
    if (request.bands)
        return *request.bands;
    const std::vector<const ReradiationMatrix*> matrices = matrices_of(material);
    if (const auto own = common_grid(matrices))
        return *own;
    if (!matrices.empty()) {
        throw_input_error({},
                          matrices.size() == 1
                              ? "the matrix's emission and excitation wavelengths share no common "
                                "grid"
                              : "the wavelengths of the substrate's matrix and of the layers' "
                                "shares share no common grid",
                          "name the bands to measure on: --bands FROM:TO:STEP");
    }
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
    PartRows rows(measurement, stack, possible_pairs({surface.coupling()}, bands.count, false));
    for (const double theta_i : request.theta_i_deg) {
        throw_if_stopped(request.stop);
        if (request.hemispherical) {
            add_hemispherical(rows, surface, theta_i);
            continue;
        }
        for (const double theta_o : request.theta_o_deg)
            for (const double phi : request.phi_deg)
                add_directional(rows, surface, rows_at(theta_i, theta_o, phi));
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
