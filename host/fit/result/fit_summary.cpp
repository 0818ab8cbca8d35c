#include "host/fit/result/fit_summary.h"

namespace reradiant {

namespace {

nlohmann::ordered_json mask_summary(const FitMask& mask) {
    nlohmann::ordered_json found = nlohmann::ordered_json::array();
    for (const FoundScatter& scatter : mask.found)
        found.push_back({{"order", scatter_order_name(scatter.line.order)},
                         {"half_width_nm", scatter.line.half_width_nm},
                         {"height", scatter.height},
                         {"entries", scatter.entries}});
    return {{"rules", mask_rules_text(mask.rules)}, {"entries", mask.measured}, {"found", found}};
}

nlohmann::ordered_json failure_of(const FitResult& result) {
    if (result.failure.empty())
        return nullptr;
    return {{"stage", result.trace.converged ? "check" : "minimisation"},
            {"message", result.failure}};
}

} // namespace

nlohmann::ordered_json fit_summary(const FitResult& result) {
    nlohmann::ordered_json yields = nlohmann::ordered_json::array();
    for (const QuantumYield& yield : result.quantum_yield)
        yields.push_back({{"value", yield.value}, {"low", yield.low}, {"high", yield.high}});
    nlohmann::ordered_json json = {{"model", fit_model_name(result.model)},
                                   {"rank", result.rank},
                                   {"rmse", result.rmse},
                                   {"relative_rmse", result.relative_rmse},
                                   {"bytes", result.bytes},
                                   {"failure", failure_of(result)},
                                   {"converged", result.trace.converged},
                                   {"kkt", result.trace.kkt},
                                   {"iterations", result.trace.iterations},
                                   {"seconds", result.seconds},
                                   {"quantum_yield", yields},
                                   {"anti_stokes_energy", result.anti_stokes_energy},
                                   {"stop_reason", result.trace.stop_reason},
                                   {"smooth_nm", result.spacing_nm},
                                   {"emission_knots_nm", result.emission_knots_nm},
                                   {"excitation_knots_nm", result.excitation_knots_nm},
                                   {"noise", result.noise},
                                   {"noise_is_estimated", result.noise_is_estimated},
                                   {"reduced_chi_squared", result.reduced_chi_squared},
                                   {"parameters", result.parameters},
                                   {"covariance_rank", result.covariance_rank},
                                   {"mask", mask_summary(result.mask)},
                                   {"within_noise", result.shortfall.empty()},
                                   {"shortfall", result.shortfall},
                                   {"notes", result.notes},
                                   {"warnings", result.warnings}};
    if (result.stack) {
        nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
        for (std::size_t k = 0; k < result.stack->names.size(); ++k) {
            const auto at = static_cast<Eigen::Index>(k);
            numbers.push_back({{"name", result.stack->names[k]},
                               {"value", result.stack->value(at)},
                               {"sigma", result.stack->sigma(at)}});
        }
        json["stack"] = {{"numbers", numbers},
                         {"rank", result.stack->rank},
                         {"reduced_chi_squared", result.stack->reduced_chi_squared},
                         {"ambiguities", result.stack->ambiguities}};
    }
    return json;
}

nlohmann::ordered_json fit_failure_summary(FitModel model, const std::string& message,
                                           const SolveProgress& progress) {
    const char* const stage = progress.minimisations == 0 ? "stack" : "minimisation";
    return {{"model", fit_model_name(model)},
            {"failure", {{"stage", stage}, {"message", message}}},
            {"converged", false},
            {"minimisations", progress.minimisations},
            {"minimisations_finished", progress.finished},
            {"iterations", progress.iterations}};
}

} // namespace reradiant
