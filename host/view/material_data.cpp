#include "host/view/material_data.h"

#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "host/scene/model/model_choice.h"
#include "host/view/tables/dyed_tables.h"
#include "host/view/tables/model_tables.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"

#include <fmt/format.h>

#include <algorithm>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

/// Re-radiation that so few terms hold to this share of it is applied as a running sum.
constexpr int most_terms = 6;
constexpr double factor_tolerance = 1e-4;

/// Nodes of the cosines of light that dyes in layers send out: to 0.2 % of it, and to some per
/// cent.
constexpr int dyed_nodes = 8, gallery_dyed_nodes = 5;

std::string spectrum_on(const Spectrum& spectrum, const WavelengthGrid& bands) {
    return encoded_floats(spectrum.at(bands.centres_nm()));
}

/// Reflectance by cosine at every band: (bands, CosineTable::nodes).
std::string reflectance_table(const std::vector<SurfaceValues>& surfaces) {
    std::vector<double> numbers;
    for (const SurfaceValues& surface : surfaces)
        for (int node = 0; node < CosineTable::nodes; ++node)
            numbers.push_back(facet_reflectance(surface, CosineTable::node_cosine(node)));
    return encoded_floats(numbers);
}

Json film_json(const ThinFilm& film, const WavelengthGrid& bands) {
    return {{"thicknessNm", film.thickness_nm}, {"ior", spectrum_on(film.ior, bands)}};
}

Json conductor_json(const Conductor& conductor, const WavelengthGrid& bands) {
    Json json = {{"ior", spectrum_on(conductor.ior, bands)},
                 {"kappa", spectrum_on(conductor.kappa, bands)},
                 {"distribution", kernel_distribution(conductor.distribution)},
                 {"alpha", conductor.alpha},
                 {"multiple", conductor.scattering == Scattering::Multiple}};
    if (conductor.film)
        json["film"] = film_json(*conductor.film, bands);
    return json;
}

/// The stacks at all bands, with their substrate.
std::vector<StackElements> stacks_of(const Material& material, const WavelengthGrid& bands) {
    std::vector<StackElements> stacks;
    for (const double nm : bands.centres_nm())
        stacks.push_back(material_at(material, nm));
    return stacks;
}

/// What surface element `index` is at every band.
std::vector<SurfaceValues> surfaces_at(const std::vector<StackElements>& stacks,
                                       std::size_t index) {
    std::vector<SurfaceValues> surfaces;
    for (const StackElements& stack : stacks)
        surfaces.push_back(*surface_of(stack[index]));
    return surfaces;
}

Json layer_json(const Layer& layer, const WavelengthGrid& bands) {
    Json json = {{"ior", spectrum_on(layer.ior, bands)},
                 {"distribution", kernel_distribution(layer.distribution)},
                 {"alpha", layer.alpha},
                 {"multiple", layer.scattering == Scattering::Multiple},
                 {"thickness", layer.thickness},
                 {"absorption", spectrum_on(layer.absorption, bands)}};
    if (layer.scatters()) {
        json["scattering"] = spectrum_on(layer.scattering_coefficient, bands);
        json["anisotropy"] = layer.anisotropy;
    }
    if (layer.film)
        json["film"] = film_json(*layer.film, bands);
    if (layer.flakes && layer.flakes->coverage > 0.0) {
        json["flakes"] = conductor_json(layer.flakes->reflector, bands);
        json["flakes"]["coverage"] = layer.flakes->coverage;
    }
    return json;
}

/// Layers from the air down; those whose reflectance is not Fresnel's plain one bring a table.
Json layers_json(const Material& material, const WavelengthGrid& bands) {
    const std::vector<StackElements> stacks = stacks_of(material, bands);
    Json layers = Json::array();
    std::size_t element = 0;
    for (const Layer& layer : material.stack.layers) {
        Json json = layer_json(layer, bands);
        if (layer.film)
            json["reflectance"] = reflectance_table(surfaces_at(stacks, element));
        element += 2; // the interface and its slab
        if (layer.flakes && layer.flakes->coverage > 0.0)
            json["flakes"]["reflectance"] = reflectance_table(surfaces_at(stacks, element++));
        layers.push_back(std::move(json));
    }
    return layers;
}

std::string encoded_matrix(const Eigen::MatrixXd& matrix) {
    std::vector<double> rows;
    for (Eigen::Index o = 0; o < matrix.rows(); ++o)
        for (Eigen::Index i = 0; i < matrix.cols(); ++i)
            rows.push_back(matrix(o, i));
    return encoded_floats(rows);
}

/// The re-radiation beside the diagonal: factors where few hold it, else the matrix by rows.
Json reradiation_json(const Eigen::MatrixXd& matrix) {
    Eigen::MatrixXd rest = matrix;
    rest.diagonal().setZero();
    if (rest.isZero(0.0))
        return nullptr;
    const bool is_lower = rest.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().isZero(0.0);
    const MaskedFactors factors = factorise_lower(matrix, most_terms, factor_tolerance);
    if (!is_lower || factors.relative_error > factor_tolerance)
        return {{"dense", encoded_matrix(rest)}};
    return {{"terms", factors.rank()},
            {"emission", encoded_matrix(factors.emission.transpose())},
            {"excitation", encoded_matrix(factors.excitation.transpose())}};
}

Json substrate_json(const Material& material, const WavelengthGrid& bands) {
    const Substrate& substrate = material.substrate;
    if (substrate.type == SubstrateType::Conductor) {
        const std::vector<StackElements> stacks = stacks_of(material, bands);
        Json json = conductor_json(substrate.conductor, bands);
        json["type"] = "conductor";
        json["reflectance"] = reflectance_table(surfaces_at(stacks, stacks.front().size() - 1));
        return json;
    }
    const SubstrateValues values = measured_substrate(substrate, bands);
    const Eigen::VectorXd diagonal = values.matrix.diagonal();
    return {{"type", values.sigma > 0.0 ? "oren-nayar" : "lambert"},
            {"sigma", values.sigma},
            {"reflectance", encoded_floats({diagonal.begin(), diagonal.end()})},
            {"reradiation", reradiation_json(values.matrix)}};
}

/// What the bands weigh in X, Y and Z, band by band.
std::string observer_weights(const WavelengthGrid& bands) {
    std::vector<double> numbers;
    for (const Xyz& weights : xyz_weights(bands))
        numbers.insert(numbers.end(), weights.begin(), weights.end());
    return encoded_floats(numbers);
}

} // namespace

namespace {

/// Returns why no model of a page can show a material, or nothing if one can.
std::optional<std::string> page_refusal(const Material& material) {
    if (material.stack.is_sheet())
        return "a page shows no sheets";
    if (material.stack.is_dyed())
        return adding_refusal(material);
    return std::nullopt;
}

} // namespace

bool is_shown_on_pages(const Material& material) {
    return !page_refusal(material);
}

ViewedModels viewed_models(const Material& material) {
    if (const std::optional<std::string> refusal = page_refusal(material))
        throw_input_error(material.position,
                          fmt::format("no model of a page can show this: {}", *refusal),
                          "`render` and `measure` show it");
    if (material.stack.is_dyed())
        return {{Model::Adding},
                {"Dyes in its layers are shown by adding as they are: nothing of them slides here, "
                 "and weidlich-wilkie does not know them."}};
    ViewedModels viewed;
    const std::optional<std::string> adding = adding_refusal(material);
    if (adding)
        viewed.notes.push_back(
            fmt::format("Shown by weidlich-wilkie, which is approximate and does not conserve "
                        "energy: {}. `render` and `measure` follow its light exactly, by walk.",
                        *adding));
    else
        viewed.models.push_back(Model::Adding);
    viewed.models.push_back(Model::WeidlichWilkie);
    if (material.model == Model::Walk)
        viewed.notes.push_back("Its file asks for the model walk, which no page shows.");
    if (material.model == Model::WeidlichWilkie)
        std::reverse(viewed.models.begin(), viewed.models.end());
    return viewed;
}

Json material_data(const ViewedMaterial& viewed, bool with_sliders) {
    const Material& material = viewed.material;
    const ViewedModels models = viewed_models(material);
    const WavelengthGrid bands = measured_bands(material, {});
    Json json = {
        {"name", viewed.name},
        {"notes", models.notes},
        {"bands", {{"from", bands.from_nm}, {"step", bands.step_nm}, {"count", bands.count}}},
        {"models", Json::array()},
        {"layers", layers_json(material, bands)},
        {"substrate", substrate_json(material, bands)},
        {"weights", observer_weights(bands)}};
    if (material.stack.is_dyed()) {
        json["dyed"] = dyed_tables(material, bands, with_sliders ? dyed_nodes : gallery_dyed_nodes);
        with_sliders = false;
    }
    for (const Model model : models.models) {
        json["models"].push_back(model_name(model));
        json[model_name(model)] = model == Model::Adding
                                      ? adding_tables(material, bands, with_sliders)
                                      : weidlich_wilkie_tables(material, bands, with_sliders);
    }
    return json;
}

} // namespace reradiant
