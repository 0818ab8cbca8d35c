#include "host/layers/sources/scattering_dyes.h"

namespace reradiant {

namespace {

/// Thinner slabs, and those that lose more, need no more cells than others (tools/tables
/// depth_cells).
constexpr double least_depth = 8.0, least_share = 0.9;

/// Clouds of another phase function keep their dyes as they are.
bool is_trap(const SlabValues& slab, double within) {
    return slab.tau_scattering == 0.0 && slab.tau > least_depth && within <= slab.tau_dyes &&
           within > least_share * slab.tau;
}

} // namespace

std::optional<ScatteringDyes> scattering_dyes(const StackElements& stack,
                                              const std::vector<Eigen::MatrixXd>& slabs,
                                              Eigen::Index band) {
    ScatteringDyes dyes{stack, {}};
    bool some = false;
    for (StackElement& element : dyes.stack) {
        auto* const slab = std::get_if<SlabValues>(&element);
        if (slab == nullptr)
            continue;
        const Eigen::MatrixXd& emission = slabs[dyes.depths.size()];
        const double within = emission.size() > 0 ? emission(band, band) : 0.0;
        const bool traps = is_trap(*slab, within);
        dyes.depths.push_back(traps ? within : 0.0);
        some = some || traps;
        if (traps) {
            slab->tau -= within;
            slab->tau_dyes -= within;
            slab->tau_scattering = within;
            slab->anisotropy = 0.0;
            slab->may_scatter = true;
        }
    }
    return some ? std::optional(std::move(dyes)) : std::nullopt;
}

} // namespace reradiant
