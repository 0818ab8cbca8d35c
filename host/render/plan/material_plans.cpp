#include "host/render/plan/material_plans.h"

#include <tbb/parallel_pipeline.h>

#include <atomic>
#include <exception>

namespace reradiant {

void plan_materials(const Scene& scene, const WavelengthPlan& wavelengths,
                    std::vector<MaterialPlan>& plans) {
    // what some are analysed with takes 100 MB, so that they are not begun all at once
    constexpr std::size_t most_at_once = 8;
    std::vector<std::exception_ptr> refusals(plans.size());
    std::atomic<bool> refused = false;
    std::size_t begun = 0;
    // in their order, so that all before one that is refused are looked at
    const auto next = [&](tbb::flow_control& control) {
        if (begun < plans.size() && !refused)
            return begun++;
        control.stop();
        return plans.size();
    };
    const auto plan_one = [&](std::size_t i) {
        try {
            plans[i] = plan_material(scene.materials[i], plans[i].choice, wavelengths);
        } catch (...) {
            refusals[i] = std::current_exception();
            refused = true;
        }
    };
    tbb::parallel_pipeline(
        most_at_once,
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, next) &
            tbb::make_filter<std::size_t, void>(tbb::filter_mode::parallel, plan_one));
    for (const std::exception_ptr& refusal : refusals)
        if (refusal)
            std::rethrow_exception(refusal);
}

} // namespace reradiant
