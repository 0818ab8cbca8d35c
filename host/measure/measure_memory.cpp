#include "host/measure/measure_memory.h"

#include "host/base/memory_limit.h"

namespace reradiant {

void check_measure_memory(const WavelengthGrid& bands, bool fluorescent,
                          const MeasureRequest& request) {
    // The substrate's matrix, the stack's answer to it, and what solving takes.
    constexpr double matrices = 6.0;
    // A row takes its numbers and their text, with 12 digits a number.
    constexpr double row_bytes = sizeof(MeasureRow) + 128.0;
    const auto count = static_cast<double>(bands.count);
    const auto directions =
        static_cast<double>(request.theta_i_deg.size()) *
        (request.hemispherical
             ? 1.0
             : static_cast<double>(request.theta_o_deg.size() * request.phi_deg.size()));
    const double rows = directions * (fluorescent ? count * (count + 3.0) / 2.0 : 2.0 * count);
    check_memory_limit({}, "the measurement",
                       matrices * count * count * sizeof(double) + rows * row_bytes,
                       request.memory_limit_bytes, "take fewer bands or directions");
}

} // namespace reradiant
