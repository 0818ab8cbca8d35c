#include "host/render/walk_tables.h"

#include "host/error.h"
#include "host/render/substrate_operator.h"
#include "host/spectral/rgb_basis.h"
#include "kernels/fresnel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace reradiant {

namespace {

constexpr double reference_nm = 550.0;
/// Distances in a scattering slab are sampled with extinctions down to this share of the largest:
/// where a lane's is smaller still, weights bounded by WALK_REFERENCES make up for it.
constexpr double least_reference = 1e-3;

void refuse(const Material& material, const std::string& file, const char* what,
            const char* remedy) {
    throw_input_error({file}, fmt::format("material '{}': {}", material.name, what), remedy);
}

bool walks_between_v_cavities(Distribution distribution, double alpha, Scattering scattering) {
    return alpha > 0.0 && distribution == Distribution::Blinn && scattering == Scattering::Multiple;
}

void check_material(const Material& material, const std::string& file) {
    const LayerStack& stack = material.stack;
    const Conductor& conductor = material.substrate.conductor;
    const bool has_conductor = material.substrate.type == SubstrateType::Conductor;
    if (stack.is_dispersive())
        refuse(material, file, "walk renders stacks whose IOR does not depend on wavelength",
               "give numbers for ior, use adding or weidlich-wilkie, or measure the material");
    if (stack.has_films() || (has_conductor && conductor.film))
        refuse(material, file, "walk renders no films", "use weidlich-wilkie");
    if (stack.has_flakes())
        refuse(material, file, "walk renders no flakes", "use weidlich-wilkie");
    bool v_cavities = has_conductor && walks_between_v_cavities(conductor.distribution,
                                                                conductor.alpha,
                                                                conductor.scattering);
    for (const Layer& layer : stack.layers)
        v_cavities |= walks_between_v_cavities(layer.distribution, layer.alpha, layer.scattering);
    if (v_cavities)
        refuse(material, file, "walk follows no light between the V-cavities of blinn",
               "give scattering = \"single\", or the distribution ggx or beckmann");
}

/// Tables over [phase][lane], lanes beyond the last 0.
class WalkTables {
public:
    WalkTables(const Material& material, const WavelengthPlan& plan, SceneTables& out)
        : material_(material), plan_(plan), out_(out), lanes_(static_cast<int>(plan.lanes.size())),
          padded_(plan.padded_lanes()) {}

    void append() {
        record_.walk = static_cast<std::uint32_t>(out_.walk_parts.size());
        record_.layer_count = static_cast<std::uint32_t>(material_.stack.layers.size());
        const auto& layers = material_.stack.layers;
        for (std::size_t k = 0; k < layers.size(); ++k)
            out_.walk_parts.push_back(
                interface_part(layers[k], k > 0 ? layers[k - 1].ior(reference_nm) : 1.0));
        append_substrate();
        out_.features.walk = true;
        out_.features.walk_layers =
            std::max(out_.features.walk_layers, static_cast<int>(layers.size()));
        out_.materials.push_back(record_);
    }

private:
    using LaneValue = std::function<double(int lane, int phase)>;

    std::uint32_t here() const { return static_cast<std::uint32_t>(out_.tables.size()); }

    std::uint32_t append_lanes(const LaneValue& value) {
        const std::uint32_t offset = here();
        for (int phase = 0; phase < plan_.phases; ++phase)
            for (int lane = 0; lane < padded_; ++lane)
                out_.tables.push_back(lane < lanes_ ? static_cast<float>(value(lane, phase))
                                                    : 0.0f);
        return offset;
    }

    std::vector<double> all_lanes(const Spectrum& spectrum, double factor) const {
        std::vector<double> values;
        for (int phase = 0; phase < plan_.phases; ++phase)
            for (int lane = 0; lane < lanes_; ++lane)
                values.push_back(factor * spectrum(plan_.wavelength_nm(lane, phase)));
        return values;
    }

    static WalkPartRecord surface_part(double alpha, Distribution distribution,
                                       Scattering scattering) {
        WalkPartRecord part{};
        part.eta = part.ior = 1.0f;
        part.alpha = static_cast<float>(alpha);
        part.distribution = static_cast<std::uint32_t>(kernel_distribution(distribution));
        part.multiple = scattering == Scattering::Multiple ? 1u : 0u;
        part.albedo = 1.0f;
        part.reflectance = part.extinction = part.scattering = NO_INDEX;
        return part;
    }

    WalkPartRecord interface_part(const Layer& layer, double ior_above) {
        const double ior = layer.ior(reference_nm);
        WalkPartRecord part = surface_part(layer.alpha, layer.distribution, layer.scattering);
        part.eta = static_cast<float>(ior / ior_above);
        part.ior = static_cast<float>(ior);
        append_slab(layer, part);
        return part;
    }

    void append_slab(const Layer& layer, WalkPartRecord& part) {
        const std::vector<double> absorption = all_lanes(layer.absorption, layer.thickness);
        const std::vector<double> scattering =
            all_lanes(layer.scattering_coefficient, layer.thickness);
        const double most_absorbed = *std::max_element(absorption.begin(), absorption.end());
        const double most_scattered = *std::max_element(scattering.begin(), scattering.end());
        if (!(most_absorbed + most_scattered > 0.0))
            return;
        const auto at = [this](int lane, int phase) {
            return static_cast<std::size_t>(phase * lanes_ + lane);
        };
        part.least_depth =
            static_cast<float>(*std::min_element(absorption.begin(), absorption.end()));
        part.extinction = append_lanes([&](int lane, int phase) {
            return absorption[at(lane, phase)] + scattering[at(lane, phase)];
        });
        if (!(most_scattered > 0.0))
            return;
        out_.features.scattering_slabs = true;
        part.scattering =
            append_lanes([&](int lane, int phase) { return scattering[at(lane, phase)]; });
        part.anisotropy = static_cast<float>(layer.anisotropy);
        set_references(absorption, scattering, part);
    }

    /// Extinctions in equal ratios from the smallest lane's to the largest's.
    static void set_references(const std::vector<double>& absorption,
                               const std::vector<double>& scattering, WalkPartRecord& part) {
        double least = std::numeric_limits<double>::infinity(), most = 0.0, albedo = 0.0;
        for (std::size_t i = 0; i < absorption.size(); ++i) {
            const double extinction = absorption[i] + scattering[i];
            least = std::min(least, extinction);
            most = std::max(most, extinction);
            albedo += extinction > 0.0 ? scattering[i] / extinction : 0.0;
        }
        least = std::max(least, least_reference * most);
        for (int r = 0; r < WALK_REFERENCES; ++r)
            part.references[r] = static_cast<float>(
                least * std::pow(most / least, r / (WALK_REFERENCES - 1.0)));
        part.albedo = static_cast<float>(albedo / static_cast<double>(absorption.size()));
    }

    void append_substrate() {
        const Substrate& substrate = material_.substrate;
        record_.first_diagonal = record_.first_factors = record_.first_dense = NO_INDEX;
        record_.factors = record_.dense = record_.reflectance_image = NO_INDEX;
        record_.rank = 0;
        if (substrate.type == SubstrateType::Conductor) {
            append_conductor(substrate.conductor);
            return;
        }
        if (substrate.type == SubstrateType::OrenNayar) {
            record_.sigma = static_cast<float>(substrate.sigma);
            out_.features.oren_nayar |= substrate.sigma > 0.0;
        }
        append_matrix(substrate);
    }

    /// Reflectance at a facet under the lowest slab, over its cosine.
    void append_conductor(const Conductor& conductor) {
        const auto& layers = material_.stack.layers;
        const double above = layers.empty() ? 1.0 : layers.back().ior(reference_nm);
        WalkPartRecord part =
            surface_part(conductor.alpha, conductor.distribution, conductor.scattering);
        part.reflectance = here();
        double sum = 0.0;
        for (int phase = 0; phase < plan_.phases; ++phase)
            for (int node = 0; node < TABLE_NODES; ++node)
                for (int lane = 0; lane < padded_; ++lane) {
                    const double u = static_cast<double>(node) / (TABLE_NODES - 1);
                    const double nm =
                        lane < lanes_ ? plan_.wavelength_nm(lane, phase) : reference_nm;
                    const double value =
                        lane < lanes_ ? kernels::fresnel_conductor(u * u, conductor.ior(nm) / above,
                                                                   conductor.kappa(nm) / above)
                                      : 0.0;
                    out_.tables.push_back(static_cast<float>(value));
                    sum += node == TABLE_NODES - 1 ? value : 0.0; // normal incidence
                }
        part.albedo = static_cast<float>(sum / (plan_.phases * lanes_));
        out_.features.tabulated_reflectance = true;
        out_.walk_parts.push_back(part);
    }

    /// M alone: what the stack sends back is walked.
    void append_matrix(const Substrate& substrate) {
        const SubstrateOnCells on_cells = substrate_on_cells(substrate, plan_.comb);
        const Eigen::VectorXd none = Eigen::VectorXd::Zero(lanes_);
        const Eigen::VectorXd one = Eigen::VectorXd::Ones(lanes_);
        std::vector<LaneOperator> operators;
        for (int phase = 0; phase < plan_.phases; ++phase)
            operators.push_back(lane_operator(substrate, on_cells, plan_, phase, none, one));
        WalkPartRecord part = surface_part(0.0, Distribution::Ggx, Scattering::Single);
        part.albedo = static_cast<float>(
            std::clamp(operators[static_cast<std::size_t>(plan_.phases / 2)].row_sums().mean(), 0.0,
                       1.0));
        out_.walk_parts.push_back(part);
        if (substrate.reflectance_image >= 0) {
            append_image(substrate);
            return;
        }
        record_.diagonal = append_lanes([&](int lane, int phase) {
            return operators[static_cast<std::size_t>(phase)].diagonal(lane);
        });
        if (on_cells.fluorescence.size() == 0)
            return;
        out_.features.fluorescence = true;
        if (on_cells.is_factored())
            append_factors(operators);
        else
            append_dense(operators);
    }

    void append_image(const Substrate& substrate) {
        out_.features.reflectance_image = true;
        record_.reflectance_image = static_cast<std::uint32_t>(substrate.reflectance_image);
        record_.diagonal = append_lanes([](int, int) { return 1.0; });
        record_.image_reflectance = append_lanes([](int, int) { return 0.0; });
        for (const Spectrum& primary : rgb_basis())
            append_lanes([&](int lane, int phase) {
                const double nm = plan_.wavelength_nm(lane, phase);
                return substrate.reflectance(nm) * primary(nm);
            });
    }

    void append_factors(const std::vector<LaneOperator>& operators) {
        const Eigen::Index rank = operators.front().emission.cols();
        record_.factors = here();
        record_.rank = static_cast<std::uint32_t>(rank);
        for (const LaneOperator& op : operators)
            for (const Eigen::MatrixXd* factor : {&op.emission, &op.excitation})
                for (Eigen::Index k = 0; k < rank; ++k)
                    for (int lane = 0; lane < padded_; ++lane)
                        out_.tables.push_back(
                            lane < lanes_ ? static_cast<float>((*factor)(lane, k)) : 0.0f);
        out_.notes.push_back(
            fmt::format("material '{}': re-radiation of rank {}", material_.name, rank));
    }

    void append_dense(const std::vector<LaneOperator>& operators) {
        record_.dense = here();
        out_.features.dense_matrix = true;
        for (const LaneOperator& op : operators)
            for (int i = 0; i < padded_; ++i)
                for (int o = 0; o < padded_; ++o)
                    out_.tables.push_back(
                        i < lanes_ && o < lanes_ ? static_cast<float>(op.dense(o, i)) : 0.0f);
        out_.notes.push_back(
            fmt::format("material '{}': dense re-radiation matrix", material_.name));
    }

    const Material& material_;
    const WavelengthPlan& plan_;
    SceneTables& out_;
    int lanes_, padded_;
    MaterialRecord record_{};
};

} // namespace

void append_walk_material(const Material& material, const WavelengthPlan& plan,
                          const std::string& file, SceneTables& tables) {
    check_material(material, file);
    WalkTables(material, plan, tables).append();
}

} // namespace reradiant
