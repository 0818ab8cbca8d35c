#pragma once

#include "reradiant/spectral_image.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reradiant {

/// A `LayerCode` holds the spectra of a light layer in some successive bands, as a page does: each
/// pixel's is a length times a direction among few basis spectra, which are orthonormal. What is
/// excited and what excites lie on either side of 400 nm, and one may be far brighter: bands below
/// and above have codes of their own.
struct LayerCode {
    int first_band = 0, bands = 0, rank = 0;
    std::vector<float> basis;             ///< (rank, bands)
    double log_low = 0.0;                 ///< length = exp(log_low + code * length_step)
    std::vector<std::uint16_t> lengths;   ///< by pixel; 0: black, else its code + 1
    std::vector<std::int16_t> directions; ///< (rank, pixel): component / direction_step
    /// Errors relative to a pixel's length: root mean square, and largest.
    double rms_error = 0.0, worst_error = 0.0;

    static constexpr double length_step = 2e-3, direction_step = 1.0 / 512.0;

    /// A pixel's spectrum as a page has it, (bands).
    std::vector<double> spectrum(std::size_t pixel) const;
};

/// Codes a layer, of as many basis spectra as hold pixels to a thousandth (root mean square),
/// 16 at most. Bands where it is dark throughout have no code.
std::vector<LayerCode> layer_codes(std::span<const float> values, const WavelengthGrid& bands);

/// Lengths and directions as a page unpacks them (host/view/lights/layers.js): differences along
/// the pixels, high bytes and low bytes by themselves, deflated (RFC 1950), in base64.
std::string packed(const LayerCode& code);

} // namespace reradiant
