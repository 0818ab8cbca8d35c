#include "host/view/tables/model_tables.h"

#include "host/layers/models/weidlich_wilkie_residual.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/report/data_uri.h"
#include "host/scene/model/closed_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

/// Shares fall exponentially with the depth: their logarithms are interpolated, of no light at all
/// that of this.
constexpr double least_share = 1e-12;

Json grid_json(const VariantGrid& grid) {
    return {{"alphas", grid.alphas},  {"ownAlpha", grid.own_alpha},   {"classOf", grid.class_of},
            {"depths", grid.depths},  {"classes", grid.bases.size()}, {"nodes", grid.nodes},
            {"absorbs", grid.absorbs}};
}

template <typename Function>
void append_table(std::vector<double>& numbers, const Function& value) {
    for (int node = 0; node < CosineTable::nodes; ++node)
        numbers.push_back(value(CosineTable::node_cosine(node)));
}

Json lobe_json(const LobeShape& lobe) {
    Json passages = Json::array();
    for (const LobePassage& passage : lobe.passages)
        passages.push_back({passage.alpha, passage.ior_above, passage.ior_below});
    Json json = {{"distribution", kernel_distribution(lobe.distribution)},
                 {"alpha", lobe.alpha},
                 {"ior", lobe.ior},
                 {"passages", passages}};
    if (lobe.is_between_facets())
        json["ratio"] = encoded_floats({lobe.table->begin(), lobe.table->end()});
    else if (lobe.table) {
        json["returned"] = encoded_floats({lobe.table->begin(), lobe.table->end()});
        json["returnedWidth"] = sampling_width(lobe, 1.0);
    }
    return json;
}

struct AddingVariant {
    std::vector<double> numbers; ///< logarithm of the internal reflectance, mean
                                 ///< of the residual, then the tables
    std::vector<LobeShape> lobes;
    bool has_top = false;
};

AddingVariant adding_variant(const StackElements& stack, double sigma) {
    const std::shared_ptr<const StackBsdf> model = closed_model(Model::Adding)(stack);
    AddingVariant variant{{std::log(std::max(model->internal_reflectance(sigma), least_share)),
                           model->residual_average()},
                          model->deeper_lobes(),
                          model->has_top_lobe()};
    append_table(variant.numbers,
                 [&](double c) { return std::log(std::max(model->transmission(c), least_share)); });
    append_table(variant.numbers, [&](double c) { return model->specular_delta(c); });
    append_table(variant.numbers, [&](double c) { return model->residual(c); });
    append_table(variant.numbers, [&](double c) { return model->specular_albedo(c); });
    for (std::size_t lobe = 0; lobe < variant.lobes.size(); ++lobe)
        append_table(variant.numbers,
                     [&](double c) { return model->lobe_amplitude(static_cast<int>(lobe), c); });
    return variant;
}

/// Variants of one width have the same lobes; where a band's media are so alike that nothing
/// scatters, the lobes are dark there.
Json shapes_json(const std::vector<AddingVariant>& variants, std::size_t per_alpha) {
    Json shapes = Json::array();
    for (std::size_t first = 0; first < variants.size(); first += per_alpha) {
        const auto most =
            std::max_element(variants.begin() + static_cast<std::ptrdiff_t>(first),
                             variants.begin() + static_cast<std::ptrdiff_t>(first + per_alpha),
                             [](const AddingVariant& a, const AddingVariant& b) {
                                 return a.lobes.size() < b.lobes.size();
                             });
        Json lobes = Json::array();
        for (const LobeShape& lobe : most->lobes)
            lobes.push_back(lobe_json(lobe));
        shapes.push_back({{"top", most->has_top}, {"lobes", lobes}});
    }
    return shapes;
}

/// Tables of an Oren-Nayar substrate beneath the middle band's stack, as it is.
Json oren_nayar_json(const Material& material, const WavelengthGrid& bands) {
    const StackElements stack = material_at(material, bands.centre_nm(bands.count / 2));
    const auto tables =
        closed_model(Model::Adding)(stack)->oren_nayar_tables(material.substrate.sigma);
    return {{"albedo", encoded_floats({tables->albedo.begin(), tables->albedo.end()})},
            {"spread", encoded_floats({tables->spread.begin(), tables->spread.end()})}};
}

} // namespace

std::string encoded_floats(const std::vector<double>& values) {
    const std::vector<float> floats(values.begin(), values.end());
    std::string planes(floats.size() * sizeof(float), '\0');
    for (std::size_t i = 0; i < planes.size(); ++i)
        planes[i % sizeof(float) * floats.size() + i / sizeof(float)] =
            reinterpret_cast<const char*>(floats.data())[i];
    return base64(planes);
}

Json adding_tables(const Material& material, const WavelengthGrid& bands, bool with_sliders) {
    const VariantGrid grid =
        variant_grid(material, bands, {.with_sliders = with_sliders, .with_conductor = false});
    const bool is_oren_nayar = material.substrate.type == SubstrateType::OrenNayar &&
                               material.substrate.sigma > 0.0 && !material.stack.layers.empty();
    const double sigma = is_oren_nayar ? material.substrate.sigma : 0.0;
    std::vector<AddingVariant> variants(grid.variants());
    tbb::parallel_for(std::size_t{0}, variants.size(), [&](std::size_t variant) {
        variants[variant] = adding_variant(grid.stack(variant), sigma);
    });
    std::size_t lobes = 0;
    for (const AddingVariant& variant : variants)
        lobes = std::max(lobes, variant.lobes.size());
    std::vector<double> numbers;
    for (AddingVariant& variant : variants) {
        variant.numbers.resize(2 + (4 + lobes) * CosineTable::nodes, 0.0);
        numbers.insert(numbers.end(), variant.numbers.begin(), variant.numbers.end());
    }
    Json json = grid_json(grid);
    json["tables"] = 4 + lobes;
    json["shapes"] = shapes_json(variants, grid.bases.size() * grid.nodes.size());
    json["numbers"] = encoded_floats(numbers);
    if (is_oren_nayar)
        json["orenNayar"] = oren_nayar_json(material, bands);
    return json;
}

Json weidlich_wilkie_tables(const Material& material, const WavelengthGrid& bands,
                            bool with_sliders) {
    const VariantGrid grid = variant_grid(material, bands, {.with_sliders = with_sliders});
    std::vector<std::vector<double>> variants(grid.variants());
    tbb::parallel_for(std::size_t{0}, variants.size(), [&](std::size_t variant) {
        const WeidlichWilkieResidual residual(grid.stack(variant));
        variants[variant] = {0.0, residual.average()};
        append_table(variants[variant], residual);
    });
    std::vector<double> numbers;
    for (const std::vector<double>& variant : variants)
        numbers.insert(numbers.end(), variant.begin(), variant.end());
    Json json = grid_json(grid);
    json["tables"] = 1;
    json["numbers"] = encoded_floats(numbers);
    return json;
}

} // namespace reradiant
