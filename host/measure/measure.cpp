#include "host/measure/measure.h"

#include "host/error.h"
#include "host/measure/surface_angles.h"
#include "host/measure/surface_model.h"
#include "host/measure/walk_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

void check_request(const MeasureRequest& request) {
    const auto check = [](const std::vector<double>& angles, const char* name, double from,
                          double to, const char* remedy) {
        if (angles.empty()) {
            throw_input_error({}, fmt::format("{} holds no angle", name), remedy);
        }
        for (const double angle : angles) {
            if (!(angle >= from) || !(angle < to)) {
                throw_input_error({}, fmt::format("{} of {} degrees is out of range", name, angle),
                                  remedy);
            }
        }
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
    RowWriter(Measurement& measurement, const SurfaceModel& surface)
        : measurement_(measurement), surface_(surface), bands_(measurement.bands.count),
          fluorescent_(!Eigen::MatrixXd(surface.centre()).isDiagonal(0.0)) {}

    void directional(double theta_i, double theta_o, double phi) {
        const kernels::Vec3 wi = direction_at(std::cos(radians(theta_i)), 0.0);
        const kernels::Vec3 wo = direction_at(std::cos(radians(theta_o)), radians(phi));
        std::vector<double> in, out;
        for (int band = 0; band < bands_; ++band) {
            in.push_back(surface_.way_in(band, wi, wo));
            out.push_back(surface_.way_out(band, wi, wo));
        }
        const auto row = [&](int i, int o, double value, MeasuredPart part) {
            add({theta_i, theta_o, phi, nm(i), nm(o), value, 0.0, part});
        };
        for_pairs([&](int i, int o, double centre) {
            const double value =
                out[static_cast<std::size_t>(o)] * centre * in[static_cast<std::size_t>(i)];
            row(i, o, value, MeasuredPart::Diffuse);
        });
        for (int band = 0; band < bands_; ++band) {
            row(band, band, surface_.specular(band, wi, wo), MeasuredPart::Specular);
        }
    }

    void hemispherical(double theta_i) {
        const double c = std::cos(radians(theta_i));
        const Eigen::MatrixXd diffuse = surface_.hemispherical_diffuse(c);
        const auto row = [&](int i, int o, double value, MeasuredPart part) {
            add({theta_i, 0.0, 0.0, nm(i), nm(o), value, 0.0, part});
        };
        for_pairs([&](int i, int o, double) { row(i, o, diffuse(o, i), MeasuredPart::Diffuse); });
        for (int band = 0; band < bands_; ++band) {
            row(band, band, surface_.hemispherical_specular(band, c), MeasuredPart::Specular);
        }
    }

private:
    double nm(int band) const { return measurement_.bands.centre_nm(band); }
    void add(const MeasureRow& row) { measurement_.rows.push_back(row); }

    /// Every (excitation, emission, matrix entry) that can hold something: the diagonal, Stokes
    /// shifts, and others where they are not zero.
    template <typename Visit>
    void for_pairs(const Visit& visit) const {
        const Eigen::MatrixXd& centre = surface_.centre();
        for (int i = 0; i < bands_; ++i) {
            for (int o = 0; o < bands_; ++o) {
                if (o == i || (fluorescent_ && (o > i || centre(o, i) != 0.0))) {
                    visit(i, o, centre(o, i));
                }
            }
        }
    }

    Measurement& measurement_;
    const SurfaceModel& surface_;
    int bands_;
    bool fluorescent_;
};

void add_notes(Measurement& measurement, const SurfaceModel& surface,
               const MeasureRequest& request) {
    double delta = 0.0, lost = 0.0;
    for (const double theta : request.theta_i_deg) {
        for (int band = 0; band < measurement.bands.count; ++band) {
            delta = std::max(delta, surface.specular_delta(band, std::cos(radians(theta))));
            lost = std::max(lost, surface.lost(band, std::cos(radians(theta))));
        }
    }
    if (delta > 0.0) {
        measurement.notes.push_back(
            request.hemispherical
                ? "specular rows include the mirror reflection of smooth interfaces"
                : fmt::format("the mirror reflection of smooth interfaces (weight up to {:.9g}) is "
                              "a delta and left out of these directional rows",
                              delta));
    }
    if (lost > 0.0) {
        measurement.notes.push_back(fmt::format(
            "scattering = \"single\" loses up to {:.6g} of the incident flux between facets",
            lost));
    }
}

WavelengthGrid bands_of(const Material& material, const MeasureRequest& request) {
    if (request.bands) {
        return *request.bands;
    }
    if (const auto own = material.substrate.own_grid()) {
        return *own;
    }
    if (material.substrate.matrix) {
        throw_input_error({},
                          "the matrix's emission and excitation wavelengths share no common grid",
                          "name the bands to measure on: --bands FROM:TO:STEP");
    }
    return grid_from_range(material.substrate.is_fluorescent() ? 300.0 : 380.0, 780.0, 10.0);
}

} // namespace

Measurement measure_stack(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                          const WavelengthGrid& bands, const MeasureRequest& request) {
    check_request(request);
    if (request.model == Model::Walk) {
        return measure_by_walk(stack, {.matrix = per_band}, bands, request);
    }
    Measurement measurement;
    measurement.bands = bands;
    measurement.hemispherical = request.hemispherical;
    measurement.model = request.model == Model::Auto ? Model::Adding : request.model;
    const std::unique_ptr<SurfaceModel> surface =
        measurement.model == Model::WeidlichWilkie ? weidlich_wilkie_surface(stack, per_band, bands)
                                                   : adding_surface(stack, per_band, bands);
    RowWriter writer(measurement, *surface);
    for (const double theta_i : request.theta_i_deg) {
        if (request.hemispherical) {
            writer.hemispherical(theta_i);
            continue;
        }
        for (const double theta_o : request.theta_o_deg) {
            for (const double phi : request.phi_deg) {
                writer.directional(theta_i, theta_o, phi);
            }
        }
    }
    add_notes(measurement, *surface, request);
    return measurement;
}

Measurement measure_material(const Material& material, const MeasureRequest& request) {
    MeasureRequest resolved = request;
    if (resolved.model == Model::Auto) {
        resolved.model = material.model;
    }
    check_request(resolved);
    const WavelengthGrid bands = bands_of(material, request);
    if (resolved.model == Model::Walk) {
        return measure_by_walk(material.stack, walk_substrate(material.substrate, bands), bands,
                               resolved);
    }
    Eigen::MatrixXd per_band = material.substrate.fluorescence_on(bands);
    for (int band = 0; band < bands.count; ++band) {
        per_band(band, band) += material.substrate.reflectance(bands.centre_nm(band));
    }
    return measure_stack(material.stack, per_band, bands, resolved);
}

} // namespace reradiant
