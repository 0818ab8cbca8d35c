#include "host/view/export/glsl_tables.h"

#include "host/layers/models/effective_matrix.h"
#include "host/layers/models/stack_bsdf.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/layers/stack/quadrature.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace reradiant {

namespace {

constexpr int most_terms = 6;
constexpr double factor_tolerance = 1e-4;

/// Makes the tables of one material.
class GlslTablesMaker {
public:
    explicit GlslTablesMaker(const Material& material) : material_(material) {
        out_.model = viewed_models(material).models.front();
        out_.bands = measured_bands(material, {});
        for (const double nm : out_.bands.centres_nm()) {
            stacks_.push_back(material_at(material, nm));
            models_.push_back(closed_model(out_.model)(stacks_.back()));
        }
    }

    GlslTables made() {
        define("RR_NODES", glsl_nodes);
        define("RR_CHUNKS", (out_.bands.count + 3) / 4);
        define("RR_DENSE", 0);
        define("RR_SENT", 0);
        define("RR_OPERATORS", 1);
        define("RR_DISPERSIVE", material_.stack.is_dispersive() ? 1 : 0);
        if (out_.model == Model::Adding)
            add_adding();
        else
            add_weidlich_wilkie();
        add_operator();
        return std::move(out_);
    }

private:
    using AtBand = std::function<double(std::size_t)>;

    std::size_t bands() const { return stacks_.size(); }
    void define(const std::string& name, int value) { out_.defines.emplace_back(name, value); }
    void define_row(const std::string& name) {
        define("RR_" + name + "_ROW", static_cast<int>(out_.rows.size()));
    }
    void add_row(const AtBand& value) {
        std::vector<double>& row = out_.rows.emplace_back();
        for (std::size_t band = 0; band < bands(); ++band)
            row.push_back(value(band));
    }
    int add_table(const std::function<double(std::size_t, double)>& value) {
        auto& table = out_.tables.emplace_back(bands());
        for (std::size_t band = 0; band < bands(); ++band)
            for (int node = 0; node < glsl_nodes; ++node)
                table[band].push_back(
                    value(band, std::pow(static_cast<double>(node) / (glsl_nodes - 1), 2)));
        return static_cast<int>(out_.tables.size()) - 1;
    }
    void constant(const char* type, const char* name, double value) {
        out_.constants.push_back(fmt::format("const {0} {1} = {0}({2:.9g});", type, name, value));
    }
    void constants(const char* type, const char* name, const std::vector<double>& values) {
        out_.constants.push_back(fmt::format("const {0} {1}[{2}] = {0}[]({0}({3:.9g}));", type,
                                             name, values.size(),
                                             fmt::join(values, fmt::format("), {}(", type))));
    }

    void add_adding();
    void add_residual(const CosineTable& several);
    void add_lobes(const std::vector<LobeShape>& lobes, std::size_t first);
    void add_top();
    void add_weidlich_wilkie();
    void add_layers(const std::vector<std::size_t>& interfaces);
    void add_parts();
    void add_operator();
    /// Table of the reflectance of a surface.
    double reflectance_table(std::size_t element) {
        return static_cast<double>(add_table([&](std::size_t b, double c) {
            return facet_reflectance(*surface_of(stacks_[b][element]), c);
        }));
    }

    const Material& material_;
    GlslTables out_;
    std::vector<StackElements> stacks_;
    std::vector<std::shared_ptr<const StackBsdf>> models_;
};

void GlslTablesMaker::add_adding() {
    // the light of several facets, whose shape is a table of thousands of numbers, joins the
    // residual
    std::vector<LobeShape> lobes = models_[bands() / 2]->deeper_lobes();
    const std::size_t first = !lobes.empty() && lobes.front().is_between_facets() ? 1 : 0;
    const CosineTable several = first == 1 ? lobe_albedo(lobes.front()) : CosineTable();
    lobes.erase(lobes.begin(), lobes.begin() + static_cast<std::ptrdiff_t>(first));
    if (first == 1)
        out_.left_out.push_back("The direction of light that met several facets of the first "
                                "interface; its amount is there.");
    if (std::ranges::any_of(lobes, [](const LobeShape& lobe) { return lobe.table != nullptr; }))
        out_.left_out.push_back("The directions of light from beneath rough interfaces are those "
                                "of a lobe of facets; its amount is there.");
    if (material_.substrate.type == SubstrateType::OrenNayar && !material_.stack.layers.empty())
        out_.left_out.push_back("The substrate beneath the layers is Lambertian instead of Oren "
                                "and Nayar's.");
    add_table([&](std::size_t b, double c) { return models_[b]->transmission(c); });
    add_table([&](std::size_t b, double c) { return models_[b]->specular_delta(c); });
    add_residual(several);
    add_lobes(lobes, first);
    define_row("SCALE");
    add_row([&](std::size_t b) { return models_[b]->diffuse_scale(); });
    define_row("IOR");
    add_row([&](std::size_t b) {
        return stacks_[b].size() > 1 ? std::get<SurfaceValues>(stacks_[b].front()).ior_below : 1.0;
    });
    add_top();
}

/// The residual with the light of several facets, whose unit lobe has the albedo `several`; its
/// tables are over the square root of its mean, times pi.
void GlslTablesMaker::add_residual(const CosineTable& several) {
    const auto residual = [&](std::size_t b, double c) {
        const double amplitude =
            models_[b]->deeper_lobes().empty() ? 0.0 : models_[b]->lobe_amplitude(0, c);
        return models_[b]->residual(c) + amplitude * amplitude * several(c);
    };
    std::vector<double> means;
    for (std::size_t b = 0; b < bands(); ++b)
        means.push_back(
            integrate_sin2(0.0, 1.0, 32, [&](double c) { return 2.0 * c * residual(b, c); }));
    add_table([&](std::size_t b, double c) {
        return means[b] > 0.0 ? residual(b, c) / std::sqrt(std::numbers::pi * means[b]) : 0.0;
    });
}

/// Amplitude of a deeper interface's lobe without the table that it is multiplied by, which is too
/// large for constants, for the same flux; dark where a band has no such lobe.
CosineTable plain_amplitude(const StackBsdf& model, std::size_t lobe) {
    if (lobe >= model.deeper_lobes().size())
        return {};
    LobeShape plain = model.deeper_lobes()[lobe];
    plain.table = nullptr;
    return fit_lobe(plain, [&](double c) { return model.lobe_shares(c)[lobe + 1]; }).amplitude;
}

/// Lobes of deeper interfaces, the model's from `first` on. Arrays of GLSL are never empty: a dark
/// one ends them.
void GlslTablesMaker::add_lobes(const std::vector<LobeShape>& lobes, std::size_t first) {
    for (std::size_t lobe = first; lobe < lobes.size() + first; ++lobe) {
        std::vector<CosineTable> amplitudes;
        for (std::size_t b = 0; b < bands(); ++b)
            amplitudes.push_back(plain_amplitude(*models_[b], lobe));
        add_table([&](std::size_t b, double c) { return amplitudes[b](c); });
    }
    std::size_t passages = 1;
    for (const LobeShape& lobe : lobes)
        passages = std::max(passages, lobe.passages.size());
    define("RR_LOBES", static_cast<int>(lobes.size()));
    define("RR_PASSAGES", static_cast<int>(passages));
    define("RR_DYE_NODES", 0);
    define("RR_HAS_RATIO", 0);
    define("RR_HAS_RETURNED", 0);
    define("RR_SPREADS", 0);
    std::vector<LobeShape> padded = lobes;
    padded.push_back({Distribution::Ggx, 1.0});
    std::vector<double> distribution, alpha, ior;
    std::string passage;
    for (const LobeShape& lobe : padded) {
        distribution.push_back(kernel_distribution(lobe.distribution));
        alpha.push_back(lobe.alpha);
        ior.push_back(lobe.ior);
        for (std::size_t p = 0; p < passages; ++p) {
            const LobePassage own =
                p < lobe.passages.size() ? lobe.passages[p] : LobePassage{0.0, 1.0, 1.0};
            passage += fmt::format("{}vec3({:.9g}, {:.9g}, {:.9g})", passage.empty() ? "" : ", ",
                                   own.alpha, own.ior_above, own.ior_below);
        }
    }
    constants("int", "rr_lobe_distribution", distribution);
    constants("float", "rr_lobe_alpha", alpha);
    constants("float", "rr_lobe_ior", ior);
    out_.constants.push_back(
        fmt::format("const vec3 rr_passage[{}] = vec3[]({});", padded.size() * passages, passage));
}

void GlslTablesMaker::add_top() {
    const StackBsdf& middle = *models_[bands() / 2];
    const bool is_bare = material_.stack.layers.empty();
    const Layer top = is_bare ? Layer{} : material_.stack.layers.front();
    constant("int", "rr_top_distribution", kernel_distribution(top.distribution));
    constant("float", "rr_top_alpha", middle.has_top_lobe() ? top.alpha : 0.0);
    constant("float", "rr_sigma", is_bare ? material_.substrate.sigma : 0.0);
    constant("float", "rr_lowest_ior", middle.lowest_ior());
    constant("float", "rr_mean_albedo", 1.0);
}

void GlslTablesMaker::add_weidlich_wilkie() {
    define("RR_LAYERS", static_cast<int>(material_.stack.layers.size()));
    add_table([&](std::size_t b, double c) { return models_[b]->residual_amplitude(c); });
    std::vector<std::size_t> interfaces;
    for (std::size_t element = 0; element + 1 < stacks_.front().size(); ++element)
        if (std::holds_alternative<SlabValues>(stacks_.front()[element + 1]))
            interfaces.push_back(element);
    add_layers(interfaces);
    add_parts();
    const bool is_metal = material_.substrate.type == SubstrateType::Conductor;
    const Conductor& metal = material_.substrate.conductor;
    constant("int", "rr_base_table",
             is_metal ? reflectance_table(stacks_.front().size() - 1) : -1.0);
    constant("float", "rr_base_alpha", is_metal ? metal.alpha : 0.0);
    constant("int", "rr_base_distribution", kernel_distribution(metal.distribution));
    constant("float", "rr_sigma", material_.substrate.sigma);
}

/// Indices and depths of the layers whose interfaces stand at these elements.
void GlslTablesMaker::add_layers(const std::vector<std::size_t>& interfaces) {
    define_row("IOR");
    for (const std::size_t e : interfaces)
        add_row([&](std::size_t b) { return std::get<SurfaceValues>(stacks_[b][e]).ior_below; });
    if (interfaces.empty())
        add_row([](std::size_t) { return 1.0; });
    define_row("DEPTH");
    for (const std::size_t e : interfaces) {
        add_row([&](std::size_t b) { return std::get<SlabValues>(stacks_[b][e + 1]).depth(); });
        add_row([&](std::size_t b) {
            const SlabValues& slab = std::get<SlabValues>(stacks_[b][e + 1]);
            return slab.scatters() ? slab.tau_scattering / slab.depth() : 0.0;
        });
    }
}

/// Interfaces and flakes; one of nothing ends the arrays.
void GlslTablesMaker::add_parts() {
    std::vector<double> distribution, alpha, table, anisotropy, cloudy, coverage, flake_alpha,
        flake_distribution, flake_table;
    std::vector<Layer> layers = material_.stack.layers;
    layers.emplace_back();
    std::size_t element = 0;
    for (const Layer& layer : layers) {
        distribution.push_back(kernel_distribution(layer.distribution));
        alpha.push_back(layer.alpha);
        table.push_back(layer.film ? reflectance_table(element) : -1.0);
        anisotropy.push_back(layer.anisotropy);
        cloudy.push_back(layer.scatters() ? 1.0 : 0.0);
        element += 2;
        const bool has_flakes = layer.flakes && layer.flakes->coverage > 0.0;
        const Flakes flakes = has_flakes ? *layer.flakes : Flakes{};
        coverage.push_back(flakes.coverage);
        flake_alpha.push_back(flakes.reflector.alpha);
        flake_distribution.push_back(kernel_distribution(flakes.reflector.distribution));
        flake_table.push_back(has_flakes ? reflectance_table(element++) : -1.0);
    }
    constants("int", "rr_layer_distribution", distribution);
    constants("float", "rr_layer_alpha", alpha);
    constants("int", "rr_layer_table", table);
    constants("float", "rr_layer_anisotropy", anisotropy);
    constants("bool", "rr_layer_is_cloudy", cloudy);
    constants("float", "rr_flake_coverage", coverage);
    constants("float", "rr_flake_alpha", flake_alpha);
    constants("int", "rr_flake_distribution", flake_distribution);
    constants("int", "rr_flake_table", flake_table);
}

/// The substrate's operator, with all that layers send back to it.
void GlslTablesMaker::add_operator() {
    const SubstrateValues values = measured_substrate(material_.substrate, out_.bands);
    const auto n = static_cast<Eigen::Index>(bands());
    SemiseparableMatrix matrix{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, 0),
                               Eigen::MatrixXd::Zero(n, 0)};
    if (values.conductor.empty()) {
        const MaskedFactors factors = factorise_lower(values.matrix, most_terms, factor_tolerance);
        matrix = {values.matrix.diagonal(), factors.emission, factors.excitation};
        if (factors.relative_error > factor_tolerance)
            out_.left_out.push_back(fmt::format("A share of {:.2g} of the re-radiation, which few "
                                                "terms do not hold.",
                                                factors.relative_error));
        if (values.matrix.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm() > 0.0)
            out_.left_out.push_back("Re-radiation to shorter wavelengths.");
        Eigen::VectorXd r(n);
        for (std::size_t band = 0; band < bands(); ++band)
            r(static_cast<Eigen::Index>(band)) = models_[band]->internal_reflectance();
        matrix = effective_semiseparable(matrix, r);
    }
    const auto terms = static_cast<int>(matrix.emission.cols());
    define("RR_TERMS", terms);
    define_row("OPERATOR");
    add_row([&](std::size_t b) { return matrix.diagonal(static_cast<Eigen::Index>(b)); });
    for (Eigen::Index k = 0; k < terms; ++k)
        for (const Eigen::MatrixXd* factor : {&matrix.excitation, &matrix.emission})
            add_row([&](std::size_t b) { return (*factor)(static_cast<Eigen::Index>(b), k); });
}

} // namespace

GlslTables glsl_tables(const Material& material) {
    return GlslTablesMaker(material).made();
}

} // namespace reradiant
