#include "host/measure/measure_memory.h"

#include "host/base/memory_limit.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Rows of one incidence or pair of directions, at most: of pairs of bands where light may change
/// its band, else of bands.
double rows_of_directions(const Material& material, double bands, bool hemispherical) {
    const double pairs = bands * (bands + 1.0) / 2.0;
    const bool is_dyed = material.stack.is_dyed();
    double rows = bands; // specular
    if (!material.stack.is_sheet())
        rows += material.is_fluorescent() ? pairs : bands;
    if (is_dyed || material.stack.scatters())
        rows += is_dyed ? pairs : bands;
    if (material.stack.is_sheet() && hemispherical)
        rows += is_dyed ? 2.0 * pairs + bands : 2.0 * bands; // transmitted and guided
    return rows;
}

} // namespace

void check_measure_memory(const Material& material, const WavelengthGrid& bands,
                          const MeasureRequest& request) {
    // The substrate's matrix, the stack's answer to it, what solving takes, and of each dyed slab
    // what its dyes send out.
    const double matrices =
        6.0 + static_cast<double>(std::ranges::count_if(material.stack.layers, &Layer::is_dyed));
    // A row takes its numbers and their text, with 12 digits a number.
    constexpr double row_bytes = sizeof(MeasureRow) + 128.0;
    const auto count = static_cast<double>(bands.count);
    const auto directions =
        static_cast<double>(request.theta_i_deg.size()) *
        (request.hemispherical
             ? 1.0
             : static_cast<double>(request.theta_o_deg.size() * request.phi_deg.size()));
    const double rows = directions * rows_of_directions(material, count, request.hemispherical);
    check_memory_limit({}, "the measurement",
                       matrices * count * count * sizeof(double) + rows * row_bytes,
                       request.memory_limit_bytes, "take fewer bands or directions");
}

} // namespace reradiant
