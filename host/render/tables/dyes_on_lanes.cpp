#include "host/render/tables/dyes_on_lanes.h"

#include "host/layers/stack/slab_emission.h"
#include "host/render/tables/substrate_operator.h"

namespace reradiant {

Eigen::MatrixXd dyes_on_lanes(const Layer& layer, const WavelengthPlan& plan, int phase) {
    if (!layer.is_dyed())
        return {};
    const auto lanes = static_cast<Eigen::Index>(plan.lanes.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(lanes, lanes);
    for (const SlabDye& dye : layer.dyes) {
        Eigen::MatrixXd sent = cells_on_lanes(dye_shares(dye, plan.comb), plan);
        for (int lane = 0; lane < static_cast<int>(lanes); ++lane)
            sent.col(lane) *= dye.concentration * layer.thickness *
                              dye.absorption(plan.wavelength_nm(lane, phase));
        sum += sent;
    }
    return sum;
}

} // namespace reradiant
