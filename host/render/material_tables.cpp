#include "host/render/scene_tables.h"
#include "host/render/stack_optics.h"
#include "host/render/substrate_operator.h"
#include "host/spectral/rgb_basis.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace reradiant {

namespace {

constexpr double reference_nm = 550.0;
/// Every component that exists keeps at least this share of the samples.
constexpr double least_choice = 0.05;

double node_cosine(int node) {
    const double u = static_cast<double>(node) / (TABLE_NODES - 1);
    return u * u;
}

/// Builds one material's tables: optics per (phase, lane), or once for a grey stack.
class MaterialTables {
public:
    MaterialTables(const Material& material, Model model, const WavelengthPlan& plan, int lobes,
                   SceneTables& out)
        : material_(material), model_(model), plan_(plan), lobes_(lobes), out_(out),
          spectral_(!material.stack.is_grey()), lanes_(static_cast<int>(plan.lanes.size())),
          padded_(plan.padded_lanes()) {
        compute_optics();
    }

    void append() {
        record_.walk = NO_INDEX;
        record_.spectral = spectral_ ? 1u : 0u;
        append_layers();
        append_lobes();
        append_stack();
        append_substrate();
        record_.choice = append_choice();
        out_.features.spectral_stack |= spectral_;
        out_.materials.push_back(record_);
    }

private:
    using Value = std::function<double(const StackOptics&)>;

    const StackOptics& optics(int phase, int lane) const {
        return *optics_[spectral_ ? static_cast<std::size_t>(phase * lanes_ + lane) : 0];
    }

    void compute_optics() {
        const int count = spectral_ ? plan_.phases * lanes_ : 1;
        optics_.resize(static_cast<std::size_t>(count));
        tbb::parallel_for(0, count, [&](int i) {
            const double wavelength =
                spectral_ ? plan_.wavelength_nm(i % lanes_, i / lanes_) : reference_nm;
            optics_[static_cast<std::size_t>(i)] =
                stack_optics(material_.stack, model_, wavelength);
        });
    }

    std::uint32_t here() const { return static_cast<std::uint32_t>(out_.tables.size()); }

    /// [node] for a grey stack, [phase][node][lane] for a spectral one.
    std::uint32_t append_nodes(const std::function<double(const StackOptics&, double)>& value) {
        const std::uint32_t offset = here();
        if (!spectral_) {
            for (int node = 0; node < TABLE_NODES; ++node)
                out_.tables.push_back(
                    static_cast<float>(value(*optics_.front(), node_cosine(node))));
            return offset;
        }
        out_.tables.resize(out_.tables.size() +
                           static_cast<std::size_t>(plan_.phases * TABLE_NODES * padded_));
        float* table = out_.tables.data() + offset;
        tbb::parallel_for(0, plan_.phases * TABLE_NODES, [&](int row) {
            for (int lane = 0; lane < lanes_; ++lane)
                table[row * padded_ + lane] = static_cast<float>(
                    value(optics(row / TABLE_NODES, lane), node_cosine(row % TABLE_NODES)));
        });
        return offset;
    }

    void append_layers() {
        record_.first_layer = static_cast<std::uint32_t>(out_.layers.size());
        record_.layer_count = static_cast<std::uint32_t>(material_.stack.layers.size());
        double above = 1.0;
        for (const Layer& layer : material_.stack.layers) {
            const double ior = layer.ior(reference_nm);
            out_.layers.push_back(
                {static_cast<float>(ior / above), static_cast<float>(layer.alpha),
                 static_cast<std::uint32_t>(kernel_distribution(layer.distribution)), NO_INDEX,
                 0.0f, NO_INDEX});
            above = ior;
        }
        const bool has_top = record_.layer_count > 0 && material_.stack.layers.front().alpha > 0.0;
        record_.has_top_lobe = has_top ? 1u : 0u;
        out_.features.rough |= has_top;
        const bool dispersive = material_.stack.is_dispersive();
        const bool model_a = model_ == Model::WeidlichWilkie && !material_.stack.is_smooth();
        record_.weidlich_wilkie = !model_a ? 0u : dispersive ? MODEL_A_PER_LANE : MODEL_A;
        out_.features.weidlich_wilkie |= model_a;
        if (model_a && dispersive)
            append_ior_ratios(material_.stack.layers.size());
        else if (has_top && !material_.stack.layers.front().ior.is_constant())
            append_ior_ratios(1);
    }

    /// IOR below over IOR above per lane, for the first `count` interfaces.
    void append_ior_ratios(std::size_t count) {
        out_.features.dispersion = true;
        for (std::size_t k = 0; k < count; ++k)
            out_.layers[record_.first_layer + k].eta_lanes = append_lanes([&](int lane, int phase) {
                const double nm = plan_.wavelength_nm(lane, phase);
                const auto& layers = material_.stack.layers;
                return layers[k].ior(nm) / (k > 0 ? layers[k - 1].ior(nm) : 1.0);
            });
    }

    void append_lobes() {
        std::vector<int> layers = deeper_lobe_layers(material_.stack);
        if (model_ == Model::WeidlichWilkie)
            std::erase_if(layers, [&](int k) {
                return material_.stack.layers[static_cast<std::size_t>(k)].alpha == 0.0;
            });
        const auto& lobes = optics_.front()->deeper_lobes();
        record_.first_lobe = static_cast<std::uint32_t>(out_.lobes.size());
        record_.lobe_count = static_cast<std::uint32_t>(lobes.size());
        for (std::size_t l = 0; l < lobes.size(); ++l)
            out_.lobes.push_back(
                {static_cast<float>(lobes[l].alpha),
                 static_cast<std::uint32_t>(kernel_distribution(lobes[l].distribution)),
                 static_cast<std::uint32_t>(layers.at(l)), NO_INDEX});
        out_.features.deeper_lobes |= !lobes.empty();
    }

    void append_stack() {
        record_.transmission =
            append_nodes([](const StackOptics& o, double c) { return o.transmission(c); });
        double largest_delta = 0.0, largest_residual = 0.0;
        for (const auto& o : optics_)
            for (int node = 0; node < TABLE_NODES; ++node) {
                largest_delta = std::max(largest_delta, o->delta(node_cosine(node)));
                largest_residual = std::max(largest_residual, o->residual(node_cosine(node)));
            }
        record_.delta = NO_INDEX;
        if (largest_delta > 0.0) {
            record_.delta = append_nodes([](const StackOptics& o, double c) { return o.delta(c); });
            out_.features.smooth = true;
        }
        record_.residual = NO_INDEX;
        if (largest_residual > 0.0)
            record_.residual =
                append_nodes([](const StackOptics& o, double c) { return o.residual(c); });
        record_.amplitude = NO_INDEX;
        for (std::uint32_t l = 0; l < record_.lobe_count; ++l) {
            const std::uint32_t offset = append_nodes([l](const StackOptics& o, double c) {
                return o.amplitude(static_cast<int>(l), c);
            });
            if (l == 0)
                record_.amplitude = offset;
        }
    }

    /// [phase][lane]; lanes beyond the last get `padding`.
    std::uint32_t append_lanes(const std::function<double(int lane, int phase)>& value,
                               float padding = 0.0f) {
        const std::uint32_t offset = here();
        for (int phase = 0; phase < plan_.phases; ++phase)
            for (int lane = 0; lane < padded_; ++lane)
                out_.tables.push_back(lane < lanes_ ? static_cast<float>(value(lane, phase))
                                                    : padding);
        return offset;
    }

    void append_substrate() {
        const SubstrateOnCells on_cells = substrate_on_cells(material_.substrate, plan_.comb);
        for (int phase = 0; phase < plan_.phases; ++phase) {
            Eigen::VectorXd r(lanes_), scale(lanes_);
            for (int lane = 0; lane < lanes_; ++lane) {
                r(lane) = optics(phase, lane).internal_reflectance();
                scale(lane) = optics(phase, lane).diffuse_scale();
            }
            operators_.push_back(
                lane_operator(material_.substrate, on_cells, plan_, phase, r, scale));
        }
        record_.first_diagonal = record_.first_factors = record_.first_dense = NO_INDEX;
        record_.reflectance_image = NO_INDEX;
        if (material_.substrate.reflectance_image >= 0)
            append_image_reflectance();
        else
            record_.diagonal = append_lanes([&](int lane, int phase) {
                return operators_[static_cast<std::size_t>(phase)].diagonal(lane);
            });
        record_.factors = NO_INDEX;
        record_.dense = NO_INDEX;
        record_.rank = 0;
        if (on_cells.fluorescence.size() == 0)
            return;
        out_.features.fluorescence = true;
        if (on_cells.is_factored())
            append_factors();
        else
            append_dense();
    }

    /// A reflectance that an image colours is put together by the kernel: the diagonal holds the
    /// factor of the substrate's operator alone.
    void append_image_reflectance() {
        out_.features.reflectance_image = true;
        record_.reflectance_image =
            static_cast<std::uint32_t>(material_.substrate.reflectance_image);
        record_.diagonal =
            append_lanes([&](int lane, int phase) { return optics(phase, lane).diffuse_scale(); });
        record_.image_reflectance = append_lanes(
            [&](int lane, int phase) { return optics(phase, lane).internal_reflectance(); });
        for (const Spectrum& primary : rgb_basis())
            append_lanes([&](int lane, int phase) {
                const double nm = plan_.wavelength_nm(lane, phase);
                return material_.substrate.reflectance(nm) * primary(nm);
            });
    }

    void append_factors() {
        record_.factors = here();
        const Eigen::Index rank = operators_.front().emission.cols();
        record_.rank = static_cast<std::uint32_t>(rank);
        for (const LaneOperator& op : operators_)
            for (const Eigen::MatrixXd* factor : {&op.emission, &op.excitation})
                for (Eigen::Index k = 0; k < rank; ++k)
                    for (int lane = 0; lane < padded_; ++lane)
                        out_.tables.push_back(lane < lanes_ ? static_cast<float>((*factor)(lane, k))
                                                            : 0.0f);
        out_.notes.push_back(
            fmt::format("material '{}': re-radiation of rank {}", material_.name, rank));
    }

    void append_dense() {
        record_.dense = here();
        out_.features.dense_matrix = true;
        for (const LaneOperator& op : operators_)
            for (int i = 0; i < padded_; ++i)
                for (int o = 0; o < padded_; ++o)
                    out_.tables.push_back(
                        i < lanes_ && o < lanes_ ? static_cast<float>(op.dense(o, i)) : 0.0f);
        out_.notes.push_back(fmt::format("material '{}': dense re-radiation matrix, it does not "
                                         "factor to 4 terms or holds anti-Stokes emission",
                                         material_.name));
    }

    /// Reflectance of each component at one angle, per lane, at the middle phase.
    std::vector<double> component_shares(double cosine, const Eigen::VectorXd& diffuse,
                                         double& albedo) const {
        const int phase = plan_.phases / 2;
        std::vector<double> shares(static_cast<std::size_t>(3 + lobes_), 0.0);
        albedo = 0.0;
        for (int lane = 0; lane < lanes_; ++lane) {
            const StackOptics& o = optics(phase, lane);
            std::vector<double> here(shares.size(), 0.0);
            here.front() = o.delta(cosine);
            double lobes = record_.has_top_lobe ? 1.0 : 0.0;
            here[1] = lobes;
            for (std::uint32_t l = 0; l < record_.lobe_count; ++l) {
                const double amplitude = o.amplitude(static_cast<int>(l), cosine);
                here[2 + l] = amplitude * amplitude;
                lobes += here[2 + l];
            }
            for (std::size_t i = 1; i + 1 < here.size() && lobes > 0.0; ++i)
                here[i] *= o.rough_share(cosine) / lobes;
            here.back() = o.transmission(cosine) * diffuse(lane) + o.residual(cosine);
            double sum = 0.0;
            for (const double share : here)
                sum += share;
            albedo += sum / lanes_;
            for (std::size_t i = 0; i < here.size() && sum > 0.0; ++i)
                shares[i] += here[i] / (sum * lanes_);
        }
        return shares;
    }

    /// Hemispherical exitance of each lane under uniform white light, over T of the way out.
    Eigen::VectorXd diffuse_reflectance() const {
        const int phase = plan_.phases / 2;
        const LaneOperator& op = operators_[static_cast<std::size_t>(phase)];
        Eigen::VectorXd entering(lanes_);
        for (int lane = 0; lane < lanes_; ++lane) {
            double sum = 0.0; // 2 integral T(c) c dc by the midpoint rule in c^2
            for (int k = 0; k < 16; ++k)
                sum += optics(phase, lane).transmission(std::sqrt((k + 0.5) / 16.0)) / 16.0;
            entering(lane) = sum;
        }
        return std::numbers::pi * op.row_sums().cwiseProduct(entering);
    }

    /// [node][components + 1]: cumulative probabilities, then the albedo.
    std::uint32_t append_choice() {
        const Eigen::VectorXd diffuse = diffuse_reflectance();
        std::vector<std::vector<double>> rows;
        std::vector<double> albedos(TABLE_NODES), largest(static_cast<std::size_t>(3 + lobes_));
        for (int node = 0; node < TABLE_NODES; ++node) {
            rows.push_back(component_shares(node_cosine(node), diffuse,
                                            albedos[static_cast<std::size_t>(node)]));
            for (std::size_t i = 0; i < largest.size(); ++i)
                largest[i] = std::max(largest[i], rows.back()[i]);
        }
        largest.back() = std::max(largest.back(), 1e-300); // a black surface still chooses
        const std::uint32_t offset = here();
        for (std::size_t node = 0; node < TABLE_NODES; ++node) {
            double sum = 0.0;
            for (std::size_t i = 0; i < largest.size(); ++i) {
                rows[node][i] = largest[i] > 0.0 ? std::max(rows[node][i], least_choice) : 0.0;
                sum += rows[node][i];
            }
            double cumulative = 0.0;
            for (const double share : rows[node]) {
                cumulative += share / sum;
                out_.tables.push_back(static_cast<float>(cumulative));
            }
            out_.tables.back() = 1.0f;
            out_.tables.push_back(static_cast<float>(std::min(1.0, albedos[node])));
        }
        return offset;
    }

    const Material& material_;
    Model model_;
    const WavelengthPlan& plan_;
    int lobes_;
    SceneTables& out_;
    bool spectral_;
    int lanes_, padded_;
    std::vector<std::unique_ptr<StackOptics>> optics_;
    std::vector<LaneOperator> operators_;
    MaterialRecord record_{};
};

} // namespace

int deeper_lobe_count(const Scene& scene) {
    std::size_t most = 0;
    for (const Material& material : scene.materials)
        most = std::max(most, deeper_lobe_layers(material.stack).size());
    return static_cast<int>(most);
}

void append_material(const Material& material, Model model, const WavelengthPlan& plan, int lobes,
                     SceneTables& tables) {
    MaterialTables(material, model, plan, lobes, tables).append();
}

} // namespace reradiant
