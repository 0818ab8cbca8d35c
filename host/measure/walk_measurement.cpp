#include "host/measure/walk_measurement.h"

#include "host/layers/stack/directions.h"
#include "host/layers/walk/walk_estimate.h"
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

using Pairs = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// The pairs (emission, excitation) that light can leave and come at: the diagonal, Stokes shifts,
/// and where the matrix has entries above the diagonal, what these reach in any number of steps,
/// between which layers above send the light back. Only the diagonal where nothing fluoresces.
Pairs possible_pairs(const Eigen::MatrixXd& matrix, int bands, bool has_layers) {
    Pairs possible = Pairs::Identity(bands, bands);
    if (matrix.size() == 0 || matrix.isDiagonal(0.0))
        return possible;
    possible = (matrix.array() != 0.0).matrix();
    for (int via = 0; has_layers && via < bands; ++via) // Warshall's transitive closure
        for (int i = 0; i < bands; ++i)
            if (possible(via, i))
                possible.col(i) = possible.col(i).array() || possible.col(via).array();
    for (int i = 0; i < bands; ++i)
        possible.col(i).tail(bands - i).setConstant(true);
    return possible;
}

/// Appends the rows of one pair of directions.
void add_rows(Measurement& measurement, const Pairs& possible, const MeasureRow& angles,
              const WalkTally::Parts& mean, const WalkTally::Parts& error) {
    const auto row = [&](int i, int o, double value, double standard_error, MeasuredPart part) {
        MeasureRow& added = measurement.rows.emplace_back(angles);
        added.lambda_i_nm = measurement.bands.centre_nm(i);
        added.lambda_o_nm = measurement.bands.centre_nm(o);
        added.value = value;
        added.standard_error = standard_error;
        added.part = part;
    };
    const int bands = measurement.bands.count;
    const bool is_full = mean.diffuse.cols() == bands;
    for (int i = 0; i < bands; ++i) {
        for (int o = 0; o < bands; ++o) {
            if (possible(o, i)) {
                const int column = is_full ? i : 0;
                row(i, o, mean.diffuse(o, column), error.diffuse(o, column), MeasuredPart::Diffuse);
            }
        }
    }
    for (int band = 0; band < bands; ++band)
        row(band, band, mean.specular(band), error.specular(band), MeasuredPart::Specular);
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

void add_notes(Measurement& measurement, const LayerWalk& walk, long samples, unsigned seed,
               double delta, double lost) {
    const auto add = [&](const std::string& note) { measurement.notes.push_back(note); };
    add(fmt::format("random walk, {} paths for each theta_i, seed {}, {}", samples, seed,
                    walk.serves_all_bands() ? "the same for all bands"
                                            : "for each excitation band"));
    if (delta > 0.0 && measurement.hemispherical) {
        add("hemispherical rows include the mirror reflection of smooth surfaces");
    } else if (delta > 0.0) {
        add(fmt::format("the mirror reflection of smooth surfaces (weight up to about {:.3g}) is a "
                        "delta and left out of these directional rows",
                        delta));
    }
    if (lost > 0.0) {
        add(fmt::format("scattering = \"single\" loses up to about {:.3g} of the incident flux "
                        "between facets on its way to the substrate",
                        lost));
    }
}

} // namespace

Measurement measure_by_walk(const LayerStack& stack, const SubstrateValues& substrate,
                            const WavelengthGrid& bands, const MeasureRequest& request) {
    Measurement measurement;
    measurement.bands = bands;
    measurement.model = Model::Walk;
    measurement.hemispherical = request.hemispherical;
    const LayerWalk walk(stack, substrate, bands.centres_nm());
    const std::vector<Detector> detectors =
        request.hemispherical ? std::vector<Detector>{} : detectors_of(request);
    std::vector<kernels::Vec3> wo;
    for (const Detector& detector : detectors)
        wo.push_back(detector.w);
    const long samples = request.samples > 0 ? request.samples : default_walk_samples;
    const Pairs possible = possible_pairs(substrate.matrix, bands.count, !stack.layers.empty());
    double delta = 0.0, lost = 0.0;
    WalkJournal journal(request);
    for (const double theta_i : request.theta_i_deg) {
        const WalkEstimate estimate =
            journal.estimate(walk, direction_at(std::cos(radians(theta_i)), 0.0), wo, samples);
        const WalkTally &mean = estimate.mean, &error = estimate.standard_error;
        MeasureRow angles{theta_i, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, MeasuredPart::Diffuse};
        if (request.hemispherical)
            add_rows(measurement, possible, angles, mean.hemispherical, error.hemispherical);
        for (std::size_t k = 0; k < detectors.size(); ++k) {
            angles.theta_o_deg = detectors[k].theta_deg;
            angles.phi_deg = detectors[k].phi_deg;
            add_rows(measurement, possible, angles, mean.directional[k], error.directional[k]);
        }
        delta = std::max(delta, mean.delta.maxCoeff());
        lost = std::max(lost, mean.lost.maxCoeff());
    }
    add_notes(measurement, walk, samples, request.seed, delta, lost);
    return measurement;
}

} // namespace reradiant
