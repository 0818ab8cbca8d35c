#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

namespace reradiant {

/// `SpectrumLimits` are the values that a spectrum may take where it is used.
struct SpectrumLimits {
    double low = 0.0;
    double high = MAX_SPECTRAL_VALUE;
    bool low_is_allowed = true;

    /// Squares of radiances must stay finite in single precision (the film's variance).
    static constexpr double MAX_SPECTRAL_VALUE = 1e18;
    static SpectrumLimits emission() { return {}; }
    static SpectrumLimits fraction() { return {.high = 1.0}; }
    static SpectrumLimits positive(double high) { return {.high = high, .low_is_allowed = false}; }
};

/// Reads a spectrum at a key of `table`. Limits are checked from 200 to 1000 nm.
/// A table of one wavelength is a constant. Errors are placed at the key, at the offending
/// element, or in the spectrum's own file.
Spectrum read_spectrum_key(const TableReader& table, const std::string& key,
                           const SpectrumLimits& limits, LoadState& state);
/// Reads a spectrum from a node, as `read_spectrum_key` does from a key; `name` is what messages
/// call it.
Spectrum read_spectrum_node(const toml::node& node, const std::string& file,
                            const SourcePosition& at, const std::string& name,
                            const SpectrumLimits& limits, LoadState& state);

} // namespace reradiant
