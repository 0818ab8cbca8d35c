#pragma once

#include "host/base/interruption.h"
#include "host/layers/walk/walk_estimate.h"
#include "host/measure/surface_model.h"
#include "host/scene/model/scene.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A `MeasureRequest` says what a virtual bispectral goniophotometer is asked for. Angles are in
/// degrees, 0 <= theta < 90; phi is the azimuth of the outgoing direction from the incident one,
/// 180 is the mirror side.
struct MeasureRequest {
    std::vector<double> theta_i_deg{0.0};
    std::vector<double> theta_o_deg{0.0};
    std::vector<double> phi_deg{0.0};
    bool hemispherical = false; ///< directional-hemispherical; theta_o and phi are not used
    Model model = Model::Auto;
    std::optional<WavelengthGrid> bands; ///< empty: the matrix's own grid
    long samples = 0;  ///< the walk's paths for each theta_i, 0: default_walk_samples
    unsigned seed = 0; ///< the walk's
    std::uint64_t memory_limit_bytes = 0; ///< 0: 80 % of the machine's
    StopFlag stop = nullptr; ///< asked between two walks, and between two pairs of directions
    /// For the walk: `walked` is what an earlier call with the same request told of every theta_i
    /// that it began. `pause` is called between walks with a function that returns the same for
    /// this call.
    std::vector<WalkState> walked = {};
    std::function<void(const std::function<std::vector<WalkState>()>& states)> pause = {};
};

enum class MeasuredPart { Diffuse, Specular };

/// One value: 1/sr in per-band form without the cosine, or unit 1 when hemispherical. Diffuse is
/// light that reached the substrate, specular is light that never did.
struct MeasureRow {
    double theta_i_deg, theta_o_deg, phi_deg;
    double lambda_i_nm, lambda_o_nm;
    double value, standard_error;
    MeasuredPart part;
};

struct Measurement {
    WavelengthGrid bands;
    Model model = Model::Adding;
    bool hemispherical = false;
    std::vector<MeasureRow> rows;
    std::vector<std::string> notes; ///< what a reader of the rows must know, a line each
};

/// Measures a material with the model that choose_model picks; a note says why. Spectra are taken
/// at band centres. Without `bands` the matrix's own grid is used; without a matrix, 300-780 nm in
/// 10 nm steps when it fluoresces, else 380-780 nm. Input Error for angles out of range and for a
/// matrix whose two grids make no common one.
Measurement measure_material(const Material& material, const MeasureRequest& request);

/// The bands that a material is measured on.
WavelengthGrid measured_bands(const Material& material, const MeasureRequest& request);

/// Measures a stack over a substrate given by its per-band matrix, (bands, bands), rows = emission.
/// `Model::Auto` means adding, and `request.bands` is not used.
Measurement measure_stack(const LayerStack& stack, const Eigen::MatrixXd& per_band,
                          const WavelengthGrid& bands, const MeasureRequest& request);

/// Measures a stack over any substrate, as measure_stack does.
Measurement measure_substrate(const LayerStack& stack, const SubstrateValues& substrate,
                              const WavelengthGrid& bands, const MeasureRequest& request);

/// A substrate at the band centres.
SubstrateValues measured_substrate(const Substrate& substrate, const WavelengthGrid& bands);

/// Writes the CSV of `measure`: notes as # lines, then the header and one line a row, 12
/// significant digits. Atomic.
void write_measurement(const std::filesystem::path& file, const Measurement& measurement);

} // namespace reradiant
