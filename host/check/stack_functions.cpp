#include "host/check/checked_function.h"

#include "kernels/stack/layer_stack.h"

namespace reradiant {

namespace {

const Accuracy share{5e-6, 1e-3, "products of shares up to 1"};
/// The stack's roughnesses are 0.2 and 0.3.
const Accuracy lobe{5e-5, 1e-4, "half vectors of refracted directions times the lobe's slope"};

/// A passage through a roughness of 0.2 from the air into glass makes a lobe a third as wide.
const Accuracy through_lobe{1e-3, 1e-4, "half vectors times the slope of a narrow lobe"};

std::vector<CheckedFunction> model_a_functions() {
    const Arguments directions{direction(), direction()};
    return {
        CHECKED_FUNCTION("model_a_descend", "kernels/stack/model_a.h", directions, 4, share,
                         const LayerDescent d =
                             model_a_descend(tables->layers, CHECK_LAYERS - 1u, 0, CHECK_VECTOR(0),
                                             CHECK_VECTOR(3));
                         out[0] = d.way_in; out[1] = d.way_out; out[2] = d.wi.z; out[3] = d.wo.z),
            CHECKED_FUNCTION(
                "model_a_nested_lobe metal", "kernels/stack/model_a.h", directions, 2, lobe,
                const LayerFacet facet = model_a_facet(tables->layers, CHECK_LAYERS - 1u, 0,
                                                       CHECK_VECTOR(0), CHECK_VECTOR(3));
                out[0] = facet.cos_h;
                out[1] = model_a_nested_lobe(tables->layers, tables->lobes[0], 0, facet)),
            CHECKED_FUNCTION(
                "model_a_nested_lobe slab", "kernels/stack/model_a.h", directions, 1, lobe,
                const LayerFacet facet =
                    model_a_facet(tables->layers, 1u, 0, CHECK_VECTOR(0), CHECK_VECTOR(3));
                out[0] = model_a_nested_lobe(tables->layers, tables->lobes[1], 0, facet)),
            CHECKED_FUNCTION("layer_stack_diffuse", "kernels/stack/layer_stack.h", directions, 2,
                             (Accuracy{5e-6, 1.0, "one is a difference of shares"}),
                             const LayerStackView stack = CHECK_STACK;
                             const LayerDiffuse d =
                                 layer_stack_diffuse(stack, CHECK_VECTOR(0), CHECK_VECTOR(3));
                             out[0] = d.diffuse; out[1] = d.first),
    };
}

std::vector<CheckedFunction> component_functions() {
    return {
        CHECKED_FUNCTION("layer_stack_choice", "kernels/stack/layer_stack.h", (Arguments{cosine()}),
                         9, share, const LayerStackView stack = CHECK_STACK;
                         const LayerChoice choice = layer_stack_choice(stack, in[0]);
                         for (uint i = 0u; i < CHOICES; ++i) out[i] = choice.cumulative[i];
                         out[CHOICES] = choice.largest_albedo),
            CHECKED_FUNCTION("layer_stack_pdf", "kernels/stack/layer_stack.h",
                             (Arguments{direction(), direction()}), 1, lobe,
                             const LayerStackView stack = CHECK_STACK;
                             const Vec3 wo = CHECK_VECTOR(0);
                             const LayerChoice choice = layer_stack_choice(stack, wo.z);
                             out[0] = layer_stack_pdf(stack, &choice, wo, CHECK_VECTOR(3))),
            CHECKED_FUNCTION("layer_stack_sample", "kernels/stack/layer_stack.h",
                             (Arguments{direction(), unit(), unit(), unit()}), 4,
                             (Accuracy{2e-5, 1.0, "components of a unit vector"}),
                             const LayerStackView stack = CHECK_STACK;
                             const Vec3 wo = CHECK_VECTOR(0);
                             const LayerChoice choice = layer_stack_choice(stack, wo.z);
                             int is_delta; const Vec3 wi = layer_stack_sample(
                                               stack, &choice, wo, in[3], in[4], in[5], &is_delta);
                             CHECK_RESULT(0, wi); out[3] = (real)is_delta),
            CHECKED_FUNCTION(
                "layer_stack_pdf sheet", "kernels/stack/layer_stack.h",
                (Arguments{direction(), direction()}), 1, lobe, LayerStackView stack = CHECK_STACK;
                AS_SHEET(stack); const Vec3 wo = CHECK_VECTOR(0);
                const LayerChoice choice = layer_stack_choice(stack, wo.z);
                out[0] = layer_stack_pdf(stack, &choice, wo, vec3(in[3], in[4], -in[5]))),
            CHECKED_FUNCTION("layer_stack_sample sheet", "kernels/stack/layer_stack.h",
                             (Arguments{direction(), unit(), unit(), unit()}), 4,
                             (Accuracy{2e-5, 1.0, "components of a unit vector"}),
                             LayerStackView stack = CHECK_STACK;
                             AS_SHEET(stack); const Vec3 wo = CHECK_VECTOR(0);
                             const LayerChoice choice = layer_stack_choice(stack, wo.z);
                             int is_delta; const Vec3 wi = layer_stack_sample(
                                               stack, &choice, wo, in[3], in[4], in[5], &is_delta);
                             CHECK_RESULT(0, wi); out[3] = (real)is_delta),
            CHECKED_FUNCTION("layer_stack_through_lobe", "kernels/stack/layer_stack.h",
                             (Arguments{direction(), direction()}), 1, through_lobe,
                             LayerStackView stack = CHECK_STACK;
                             AS_SHEET(stack);
                             out[0] = layer_stack_through_lobe(stack, vec3(in[3], in[4], -in[5]),
                                                               CHECK_VECTOR(0))),
            CHECKED_FUNCTION("layer_stack_top", "kernels/stack/layer_stack.h",
                             (Arguments{direction(), direction()}), 1, lobe,
                             const LayerStackView stack = CHECK_STACK;
                             out[0] = layer_stack_top(stack, CHECK_VECTOR(0), CHECK_VECTOR(3))),
            CHECKED_FUNCTION("facet_shape_value", "kernels/scatter/facet_shape.h",
                             (Arguments{direction(), direction()}), 1,
                             (Accuracy{5e-6, 1e-2, "places among nodes, by logarithms"}),
                             out[0] = facet_shape_value(tables->shape, REAL(0.2), CHECK_VECTOR(0),
                                                        CHECK_VECTOR(3))),
            CHECKED_FUNCTION("lobe_ratio_value", "kernels/scatter/lobe_ratio.h",
                             (Arguments{direction(), direction()}), 1,
                             (Accuracy{5e-6, 1e-2, "places among nodes, by logarithms"}),
                             out[0] = lobe_ratio_value(tables->ratio, REAL(0.2), CHECK_VECTOR(0),
                                                       CHECK_VECTOR(3))),
            CHECKED_FUNCTION("oren_nayar_separable_albedo", "kernels/scatter/oren_nayar_shape.h",
                             (Arguments{cosine()}), 1, (Accuracy{5e-6, 1e-2, "places among nodes"}),
                             out[0] = oren_nayar_separable_albedo(tables->shape, in[0])),
            CHECKED_FUNCTION(
                "oren_nayar_spread_value", "kernels/scatter/oren_nayar_shape.h",
                (Arguments{direction(), direction()}), 1,
                (Accuracy{5e-6, 1e-2, "places among nodes"}),
                out[0] = oren_nayar_spread_value(tables->shape, CHECK_VECTOR(0), CHECK_VECTOR(3))),
    };
}

} // namespace

std::vector<CheckedFunction> stack_functions() {
    std::vector<CheckedFunction> all = model_a_functions();
    for (const CheckedFunction& function : component_functions())
        all.push_back(function);
    return all;
}

} // namespace reradiant
