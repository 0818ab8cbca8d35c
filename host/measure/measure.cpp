#include "reradiant/measure.h"

#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/directions.h"
#include "host/measure/measure_memory.h"
#include "host/measure/measure_substrate.h"
#include "host/measure/walk_measurement.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/matrix_grids.h"
#include "host/scene/model/model_choice.h"
#include "host/scene/model/substrate.h"
#include "reradiant/error.h"

#include <Eigen/Core>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

void check_request(const MeasureRequest& request) {
    const auto check = [](const std::vector<double>& angles, const char* name, double from,
                          double to, const char* remedy) {
        if (angles.empty())
            throw_input_error({}, fmt::format("{} holds no angle", name), remedy);
        for (const double angle : angles)
            if (!(angle >= from) || !(angle < to))
                throw_input_error({}, fmt::format("{} of {} degrees is out of range", name, angle),
                                  remedy);
    };
    const char* const polar = "angles from the normal lie between 0 and below 90 degrees";
    check(request.theta_i_deg, "theta-i", 0.0, 90.0, polar);
    if (!request.hemispherical) {
        check(request.theta_o_deg, "theta-o", 0.0, 90.0, polar);
        check(request.phi_deg, "phi", -360.0, 360.0 + 1e-9,
              "azimuths lie between -360 and 360 degrees");
    }
}

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

/// Appends the rows of one run and knows which wavelength pairs are possible.
class RowWriter {
public:
    RowWriter(Measurement& measurement, const LayeredBsdf& surface)
        : measurement_(measurement), surface_(surface), bands_(measurement.bands.count),
          fluorescent_(!Eigen::MatrixXd(surface.coupling()).isDiagonal(0.0)) {}

    void directional(double theta_i, double theta_o, double phi) {
        const kernels::Vec3 wi = direction_at(std::cos(radians(theta_i)), 0.0);
        const kernels::Vec3 wo = direction_at(std::cos(radians(theta_o)), radians(phi));
        MeasureRow row{theta_i, theta_o, phi, 0.0, 0.0, 0.0, 0.0, MeasuredPart::Diffuse};
        diffuse(row, surface_.diffuse(wi, wo));
        specular(row, [&](int band) { return surface_.at(band).specular(wi, wo); });
    }

    void hemispherical(double theta_i) {
        const double c = std::cos(radians(theta_i));
        MeasureRow row{theta_i, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, MeasuredPart::Diffuse};
        diffuse(row, surface_.diffuse_albedo(c));
        specular(row, [&](int band) { return surface_.at(band).specular_albedo(c); });
    }

private:
    void add(MeasureRow row, int i, int o, double value, MeasuredPart part) {
        row.lambda_i_nm = measurement_.bands.centre_nm(i);
        row.lambda_o_nm = measurement_.bands.centre_nm(o);
        row.value = value;
        row.part = part;
        measurement_.rows.push_back(row);
    }

    /// Every (excitation, emission) that can hold something: the diagonal, Stokes shifts, and
    /// others where they are not zero.
    void diffuse(const MeasureRow& row, const Eigen::MatrixXd& values) {
        const Eigen::MatrixXd& coupling = surface_.coupling();
        for (int i = 0; i < bands_; ++i) {
            for (int o = 0; o < bands_; ++o)
                if (o == i || (fluorescent_ && (o > i || coupling(o, i) != 0.0)))
                    add(row, i, o, values(o, i), MeasuredPart::Diffuse);
        }
    }
    template <typename Value>
    void specular(const MeasureRow& row, const Value& value) {
        for (int band = 0; band < bands_; ++band)
            add(row, band, band, value(band), MeasuredPart::Specular);
    }

    Measurement& measurement_;
    const LayeredBsdf& surface_;
    int bands_;
    bool fluorescent_;
};

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
    check_request(request);
    if (request.model == Model::Walk)
        return measure_by_walk(stack, substrate, bands, request);
    Measurement measurement;
    measurement.bands = bands;
    measurement.hemispherical = request.hemispherical;
    measurement.model = request.model == Model::Auto ? Model::Adding : request.model;
    const LayeredBsdf surface(stack, substrate, bands, closed_model(measurement.model));
    RowWriter writer(measurement, surface);
    for (const double theta_i : request.theta_i_deg) {
        throw_if_stopped(request.stop);
        if (request.hemispherical) {
            writer.hemispherical(theta_i);
            continue;
        }
        for (const double theta_o : request.theta_o_deg)
            for (const double phi : request.phi_deg)
                writer.directional(theta_i, theta_o, phi);
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
    check_request(resolved);
    const WavelengthGrid bands = measured_bands(material, request);
    check_measure_memory(bands, material.is_fluorescent(), request);
    Measurement measurement = measure_substrate(
        material.stack, measured_substrate(material.substrate, bands), bands, resolved);
    if (!choice.reason.empty())
        measurement.notes.insert(measurement.notes.begin(), choice.reason);
    return measurement;
}

} // namespace reradiant
