#pragma once

#include "reradiant/interruption.h"
#include "reradiant/scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct WalkContinuation; // host/measure/walk_continuation.h

/// A `MeasureRequest` says what a virtual bispectral goniophotometer is asked for. Angles are in
/// degrees, 0 <= theta < 90, of sheets also 90 < theta <= 180, beneath them: light comes from below
/// or is looked for there. phi is the azimuth of the outgoing direction from the incident one, 180
/// is the mirror side.
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
    const WalkContinuation* walks = nullptr; ///< what an earlier call came to; null: nothing
};

/// What light has met. Diffuse light reached the substrate; slab light never did, but was scattered
/// or re-emitted in a slab; specular light was neither. In hemispherical rows of sheets these leave
/// on the side where the light came; what leaves on the other is transmitted (scattered or
/// re-emitted) or transmitted-specular, and guided light stays between smooth clear faces for ever.
enum class MeasuredPart { Diffuse, Slab, Specular, Transmitted, TransmittedSpecular, Guided };
inline constexpr int measured_parts = 6;
/// As files spell it.
const char* part_name(MeasuredPart part);
/// True for the first three: what directional rows hold, and what a sample sends back.
inline bool is_reflected(MeasuredPart part) {
    return part <= MeasuredPart::Specular;
}

/// One value: 1/sr in per-band form without the cosine, or unit 1 when hemispherical.
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
    bool of_sheet = false;
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

/// What becomes of the light that comes in one band, all parts and bands of emission taken
/// together: its power, and its photons, each over what came. Smallest and largest over the bands.
struct MeasuredBalance {
    double theta_i_deg;
    double smallest_energy, largest_energy;
    double smallest_photons, largest_photons;
};
/// The balance of every theta_i of a hemispherical measurement, in its order; of another nothing.
std::vector<MeasuredBalance> measured_balances(const Measurement& measurement);

/// Writes the CSV of `measure`: notes as # lines, then the header and one line a row, 12
/// significant digits. Atomic.
void write_measurement(const std::filesystem::path& file, const Measurement& measurement);

} // namespace reradiant
