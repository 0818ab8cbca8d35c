#include "host/measure/walk_measurement.h"

#include "host/layers/stack/directions.h"
#include "host/layers/stack/slab_emission.h"
#include "host/layers/walk/walk_estimate.h"
#include "host/measure/row_writer.h"
#include "host/measure/walk_continuation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

/// An outgoing direction with the angles that it was asked for by.
struct Detector {
    double theta_deg, phi_deg;
    kernels::Vec3 w;
};

std::vector<Detector> detectors_of(const MeasureRequest& request) {
    std::vector<Detector> detectors;
    for (const double theta : request.theta_o_deg)
        for (const double phi : request.phi_deg)
            detectors.push_back({theta, phi, direction_at(std::cos(radians(theta)), radians(phi))});
    return detectors;
}

PartValues values_of(const WalkTally::Parts& parts) {
    return {parts.diffuse, parts.slab, parts.specular};
}

void add_hemispherical(PartRows& rows, double theta_i, const WalkEstimate& found, bool of_sheet) {
    const MeasureRow angles = rows_at(theta_i);
    const WalkTally &mean = found.mean, &error = found.standard_error;
    rows.add_reflected(angles, values_of(mean.hemispherical), values_of(error.hemispherical));
    if (of_sheet)
        rows.add_transmitted(angles, values_of(mean.transmitted), values_of(error.transmitted));
    rows.add_guided(angles, mean.guided, error.guided);
}

/// A `WalkJournal` keeps the state of the walk of every theta_i, in order, and tells it to a
/// request that wants to hear of it.
class WalkJournal {
public:
    explicit WalkJournal(const MeasureRequest& request)
        : request_(request), continuation_(request.walks ? *request.walks : WalkContinuation{}) {}

    WalkEstimate estimate(const LayerWalk& walk, const kernels::Vec3& wi,
                          std::span<const kernels::Vec3> wo, long samples) {
        const std::size_t index = told_.size();
        const bool begun = index < continuation_.states.size();
        told_.push_back(begun ? continuation_.states[index] : WalkState{});
        const WalkState from = told_.back();
        const WalkPause pause = [&](bool is_done, const std::function<WalkState()>& state) {
            if (is_done)
                told_.back() = state();
            continuation_.pause([&] {
                told_.back() = state();
                return told_;
            });
        };
        return estimate_walk(walk, wi, wo, static_cast<std::uint64_t>(samples), request_.seed,
                             request_.stop, from, continuation_.pause ? pause : WalkPause{});
    }

private:
    const MeasureRequest& request_;
    WalkContinuation continuation_;
    std::vector<WalkState> told_;
};

/// The largest shares of the incident light that are not where one may look for them.
struct Remarks {
    double delta = 0.0, delta_transmitted = 0.0, lost = 0.0, guided = 0.0;

    void add(const WalkTally& mean) {
        delta = std::max(delta, mean.delta.maxCoeff());
        delta_transmitted = std::max(delta_transmitted, mean.delta_transmitted.maxCoeff());
        lost = std::max(lost, mean.lost.maxCoeff());
        guided = std::max(guided, mean.guided.colwise().sum().maxCoeff());
    }
};

std::string note_of_deltas(const Remarks& remarks) {
    if (!(remarks.delta_transmitted > 0.0))
        return fmt::format("the mirror reflection of smooth surfaces (weight up to about {:.3g}) "
                           "is a delta and left out of these directional rows",
                           remarks.delta);
    return fmt::format("the mirror reflection of smooth surfaces (weight up to about {:.3g}) and "
                       "what passes them straight on ({:.3g}) are deltas and left out of these "
                       "directional rows",
                       remarks.delta, remarks.delta_transmitted);
}

void add_notes(Measurement& measurement, const LayerWalk& walk, long samples, unsigned seed,
               const Remarks& remarks) {
    const auto add = [&](const std::string& note) { measurement.notes.push_back(note); };
    add(fmt::format("random walk, {} paths for each theta_i, seed {}, {}", samples, seed,
                    walk.serves_all_bands() ? "the same for all bands"
                                            : "for each excitation band"));
    const bool has_deltas = remarks.delta > 0.0 || remarks.delta_transmitted > 0.0;
    if (has_deltas && measurement.hemispherical)
        add("hemispherical rows include the mirror reflection of smooth surfaces");
    else if (has_deltas)
        add(note_of_deltas(remarks));
    if (remarks.lost > 0.0)
        add(fmt::format("scattering = \"single\" loses up to about {:.3g} of the incident flux "
                        "between facets on its way to the substrate",
                        remarks.lost));
    if (remarks.guided > 0.0)
        add(fmt::format("smooth clear faces guide up to about {:.3g} of the incident flux, which "
                        "never leaves",
                        remarks.guided));
}

} // namespace

Measurement measure_by_walk(const LayerStack& stack, const SubstrateValues& substrate,
                            const WavelengthGrid& bands, const MeasureRequest& request) {
    Measurement measurement;
    measurement.bands = bands;
    measurement.model = Model::Walk;
    measurement.hemispherical = request.hemispherical;
    measurement.of_sheet = stack.is_sheet();
    std::vector<Eigen::MatrixXd> couplings = slab_emissions(stack, bands);
    const LayerWalk walk(stack, substrate, bands.centres_nm(), couplings);
    if (!stack.is_sheet())
        couplings.push_back(substrate.matrix);
    PartRows rows(measurement, stack,
                  possible_pairs(couplings, bands.count, !stack.layers.empty()));
    const std::vector<Detector> detectors =
        request.hemispherical ? std::vector<Detector>{} : detectors_of(request);
    std::vector<kernels::Vec3> wo;
    for (const Detector& detector : detectors)
        wo.push_back(detector.w);
    const long samples = request.samples > 0 ? request.samples : default_walk_samples;
    Remarks remarks;
    WalkJournal journal(request);
    for (const double theta_i : request.theta_i_deg) {
        const WalkEstimate found =
            journal.estimate(walk, direction_at(std::cos(radians(theta_i)), 0.0), wo, samples);
        if (request.hemispherical)
            add_hemispherical(rows, theta_i, found, stack.is_sheet());
        for (std::size_t k = 0; k < detectors.size(); ++k)
            rows.add_reflected(rows_at(theta_i, detectors[k].theta_deg, detectors[k].phi_deg),
                               values_of(found.mean.directional[k]),
                               values_of(found.standard_error.directional[k]));
        remarks.add(found.mean);
    }
    add_notes(measurement, walk, samples, request.seed, remarks);
    return measurement;
}

} // namespace reradiant
