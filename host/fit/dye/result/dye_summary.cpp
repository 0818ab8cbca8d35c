#include "host/fit/dye/result/dye_summary.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const BandedNumber& number) {
    return {{"value", number.value}, {"low", number.low}, {"high", number.high}};
}

Json json_of(const Eigen::VectorXd& values) {
    return std::vector<double>(values.data(), values.data() + values.size());
}

Json json_of(const FittedDye& dye) {
    return {{"quantum_yield", json_of(dye.quantum_yield)},
            {"peak_depth", json_of(dye.peak_depth)},
            {"absorption", json_of(dye.absorption)},
            {"absorption_sigma", json_of(dye.absorption_sigma)},
            {"emission", json_of(dye.emission)},
            {"emission_sigma", json_of(dye.emission_sigma)}};
}

Json json_of(const FittedDyeData& set) {
    return {{"file", set.data.file.string()},
            {"depth_factor", set.depth_factor},
            {"mask", mask_rules_text(set.mask.rules)},
            {"masked", set.mask.measured},
            {"saturated", set.saturated}};
}

Json json_of(const DyeEvidence& evidence) {
    return {{"dyes", evidence.dyes},
            {"chi_squared", evidence.chi_squared},
            {"criterion", evidence.criterion},
            {"parameters", evidence.parameters},
            {"converged", evidence.converged}};
}

Json list_of(const auto& things) {
    Json list = Json::array();
    for (const auto& thing : things)
        list.push_back(json_of(thing));
    return list;
}

std::string banded_text(const BandedNumber& number) {
    return fmt::format("{:.4g} ({:.4g} to {:.4g})", number.value, number.low, number.high);
}

} // namespace

Json dye_fit_summary(const DyeFitResult& result) {
    Json yields = Json::array();
    for (const FittedDye& dye : result.dyes)
        yields.push_back(json_of(dye.quantum_yield));
    const Json failure = result.failure.empty()
                             ? Json(nullptr)
                             : Json{{"stage", "minimisation"}, {"message", result.failure}};
    Json json = {{"model", "dyes"},
                 {"rank", result.dyes.size()},
                 {"rmse", result.rmse},
                 {"relative_rmse", result.relative_rmse},
                 {"failure", failure},
                 {"converged", result.trace.converged},
                 {"kkt", result.trace.kkt},
                 {"iterations", result.trace.iterations},
                 {"seconds", result.seconds},
                 {"quantum_yield", yields},
                 {"quantum_yield_inner_filter", result.inner_filter_yield},
                 {"stop_reason", result.trace.stop_reason},
                 {"smooth_nm", result.spacing_nm},
                 {"noise", result.noise},
                 {"noise_is_estimated", result.noise_is_estimated},
                 {"reduced_chi_squared", result.reduced_chi_squared},
                 {"parameters", result.parameters},
                 {"covariance_rank", result.covariance_rank},
                 {"within_noise", result.shortfall.empty()},
                 {"shortfall", result.shortfall},
                 {"bands_nm", result.bands.centres_nm()},
                 {"dyes", list_of(result.dyes)},
                 {"evidence", list_of(result.evidence)},
                 {"data", list_of(result.sets)},
                 {"notes", result.notes},
                 {"warnings", result.warnings}};
    if (result.scale)
        json["scale"] = json_of(*result.scale);
    if (result.reflectance.size() > 0) {
        json["reflectance"] = json_of(result.reflectance);
        json["reflectance_sigma"] = json_of(result.reflectance_sigma);
    }
    return json;
}

std::vector<std::string> dye_sentences(const DyeFitResult& result) {
    std::vector<std::string> sentences;
    for (std::size_t k = 0; k < result.dyes.size(); ++k) {
        const FittedDye& dye = result.dyes[k];
        Eigen::Index at = 0;
        dye.absorption.maxCoeff(&at);
        sentences.push_back(fmt::format("dye {}: quantum yield {}, optical depth {} at {} nm",
                                        k + 1, banded_text(dye.quantum_yield),
                                        banded_text(dye.peak_depth),
                                        result.bands.centre_nm(static_cast<int>(at))));
    }
    if (std::isfinite(result.inner_filter_yield))
        sentences.push_back(fmt::format("by the inner-filter correction, without re-absorbed light "
                                        "and over black, the yield would be {:.4g}",
                                        result.inner_filter_yield));
    if (result.scale)
        sentences.push_back("one radiance factor is " + banded_text(*result.scale) +
                            " of the data's unit");
    for (const DyeEvidence& evidence : result.evidence)
        sentences.push_back(fmt::format("{} dye{}: chi squared {:.1f} of {} data, criterion {:.1f}",
                                        evidence.dyes, evidence.dyes == 1 ? "" : "s",
                                        evidence.chi_squared, result.data_count,
                                        evidence.criterion));
    return sentences;
}

} // namespace reradiant
