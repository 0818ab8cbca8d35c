#include "host/scene/model/closed_model.h"

#include "host/layers/models/adding.h"
#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/layers/stack/stack_variants.h"
#include "reradiant/error.h"

namespace reradiant {

ClosedModel closed_model(Model model) {
    if (model == Model::Adding)
        return adding_bsdf;
    if (model == Model::WeidlichWilkie)
        return weidlich_wilkie_bsdf;
    throw_input_error({}, std::string("a closed form was asked of the model ") + model_name(model),
                      "use adding or weidlich-wilkie; the walk has functions of its own");
}

StackElements material_at(const Material& material, double wavelength_nm, Side from) {
    const Substrate& substrate = material.substrate;
    StackElements stack = stack_at(material.stack, wavelength_nm);
    if (substrate.type == SubstrateType::None)
        return from == Side::Above ? stack : upside_down(stack);
    if (substrate.type == SubstrateType::Conductor)
        return stack_over(std::move(stack), conductor_at(substrate.conductor, wavelength_nm));
    const double sigma = substrate.type == SubstrateType::OrenNayar ? substrate.sigma : 0.0;
    return stack_over(std::move(stack), DiffuseValues{.sigma = sigma});
}

} // namespace reradiant
