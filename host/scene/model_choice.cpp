#include "host/scene/model_choice.h"

#include "host/layers/adding.h"

namespace reradiant {

std::optional<std::string> adding_refusal(const Material& material) {
    if (material.substrate.type == SubstrateType::Conductor) {
        return "adding does not know conductors";
    }
    return adding_refusal(material.stack);
}

ModelChoice choose_model(const Material& material, Model requested, ModelUse use) {
    const Model model = requested == Model::Auto ? material.model : requested;
    const std::optional<std::string> refusal = adding_refusal(material);
    if (model == Model::Adding && refusal) {
        throw_input_error({}, *refusal, "use the model auto, walk or weidlich-wilkie");
    }
    if (model != Model::Auto) {
        return {model, ""};
    }
    if (!refusal) {
        return {Model::Adding, "auto: adding, every interreflection over the diffuse substrate"};
    }
    if (use == ModelUse::Measure) {
        return {Model::Walk, "auto: walk, because " + *refusal};
    }
    return {Model::WeidlichWilkie, "auto: weidlich-wilkie, because " + *refusal +
                                       "; it is fast and approximate, walk is exact and slow"};
}

} // namespace reradiant
