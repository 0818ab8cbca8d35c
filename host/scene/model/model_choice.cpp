#include "host/scene/model/model_choice.h"

#include "reradiant/stack_model.h"

namespace reradiant {

std::optional<std::string> adding_refusal(const Material& material) {
    if (material.substrate.type == SubstrateType::Conductor)
        return "adding does not know conductors";
    return adding_refusal(material.stack);
}

std::optional<std::string> device_walk_refusal(const Material& material) {
    if (material.stack.is_dispersive())
        return "the renderer's walk needs an IOR that does not depend on wavelength";
    if (material.stack.has_films())
        return "the renderer's walk knows no films between dielectrics";
    for (const Layer& layer : material.stack.layers)
        if (layer.flakes && !(layer.flakes->reflector.alpha > 0.0))
            return "the renderer's walk knows no smooth flakes";
    return std::nullopt;
}

namespace {

/// Chooses a model for a material that adding cannot do.
ModelChoice choose_beyond_adding(const Material& material, const std::string& refusal,
                                 ModelUse use) {
    const ModelChoice walk{Model::Walk, "auto: walk, because " + refusal};
    if (use == ModelUse::Measure)
        return walk;
    if (material.stack.layers.empty()) {
        return {Model::WeidlichWilkie,
                "auto: weidlich-wilkie, the reflection by the facets of a bare conductor"};
    }
    const std::string approximate = "; it is approximate and its energy is not bounded";
    if (const std::optional<std::string> reason = device_walk_refusal(material)) {
        return {Model::WeidlichWilkie,
                "auto: weidlich-wilkie, because " + refusal + " and " + *reason + approximate};
    }
    if (use == ModelUse::RenderHero) {
        return {Model::WeidlichWilkie, "auto: weidlich-wilkie, because " + refusal +
                                           " and hero wavelengths do not go with walk" +
                                           approximate};
    }
    return walk;
}

} // namespace

ModelChoice choose_model(const Material& material, Model requested, ModelUse use) {
    const Model model = requested == Model::Auto ? material.model : requested;
    const std::optional<std::string> refusal = adding_refusal(material);
    if (model == Model::Adding && refusal) {
        throw_input_error(material.position, *refusal,
                          "use the model auto, walk or weidlich-wilkie");
    }
    if (model != Model::Auto)
        return {model, ""};
    if (!refusal)
        return {Model::Adding, "auto: adding, every interreflection over the diffuse substrate"};
    return choose_beyond_adding(material, *refusal, use);
}

} // namespace reradiant
