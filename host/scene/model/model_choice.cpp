#include "host/scene/model/model_choice.h"

#include "reradiant/stack_model.h"

namespace reradiant {

std::optional<std::string> adding_refusal(const Material& material) {
    const Substrate& substrate = material.substrate;
    if (substrate.type == SubstrateType::Conductor)
        return "adding does not know conductors";
    if (substrate.type == SubstrateType::OrenNayar && substrate.sigma > 0.0 &&
        material.stack.is_dyed())
        return "adding does not know Oren-Nayar substrates beneath dyes";
    return adding_refusal(material.stack);
}

std::optional<std::string> weidlich_wilkie_refusal(const Material& material) {
    if (material.stack.is_dyed())
        return "weidlich-wilkie does not know dyes in layers: it follows no light between the "
               "slabs";
    if (material.stack.is_sheet())
        return "weidlich-wilkie does not know sheets: it follows no light between the slabs";
    return std::nullopt;
}

std::optional<ModelRefusal> model_refusal(const Material& material, Model model) {
    const std::optional<std::string> closed_form = weidlich_wilkie_refusal(material);
    if (model == Model::WeidlichWilkie && closed_form)
        return ModelRefusal{*closed_form, "use the model auto, adding or walk"};
    if (model != Model::Adding)
        return std::nullopt;
    if (const std::optional<std::string> refusal = adding_refusal(material))
        return ModelRefusal{*refusal, closed_form ? "use the model auto or walk"
                                                  : "use the model auto, walk or weidlich-wilkie"};
    return std::nullopt;
}

std::optional<std::string> device_walk_refusal(const Material& material) {
    if (material.stack.is_dispersive())
        return "the renderer's walk needs an IOR that does not depend on wavelength";
    if (material.stack.has_films())
        return "the renderer's walk knows no films between dielectrics";
    for (const Layer& layer : material.stack.layers) {
        if (layer.flakes && material.stack.is_sheet())
            return "the renderer's walk knows no flakes in sheets";
        if (layer.flakes && !(layer.flakes->reflector.alpha > 0.0))
            return "the renderer's walk knows no smooth flakes";
    }
    return std::nullopt;
}

namespace {

/// Chooses a model for a material that adding cannot do.
ModelChoice choose_beyond_adding(const Material& material, const std::string& refusal,
                                 ModelUse use) {
    const ModelChoice walk{Model::Walk, "auto: walk, because " + refusal};
    if (use == ModelUse::Measure || weidlich_wilkie_refusal(material))
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

ModelChoice choose_by_itself(const Material& material, ModelUse use) {
    if (const std::optional<std::string> refusal = adding_refusal(material))
        return choose_beyond_adding(material, *refusal, use);
    return {Model::Adding, material.stack.is_sheet()
                               ? "auto: adding, every interreflection within the sheet"
                               : "auto: adding, every interreflection over the diffuse substrate"};
}

} // namespace

ModelChoice choose_model(const Material& material, Model requested, ModelUse use) {
    const Model model = requested == Model::Auto ? material.model : requested;
    if (const std::optional<ModelRefusal> refusal = model_refusal(material, model))
        throw_input_error(material.position, refusal->reason, refusal->remedy);
    return model == Model::Auto ? choose_by_itself(material, use) : ModelChoice{model, ""};
}

} // namespace reradiant
