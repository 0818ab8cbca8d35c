#include "host/render/tables/choice_tables.h"
#include "host/render/tables/scene_tables.h"
#include "host/render/tables/stack_parts.h"
#include "host/render/tables/substrate_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace reradiant {

namespace {

/// Builds one material's records and tables.
class MaterialTables {
public:
    MaterialTables(const Material& material, Model model, const WavelengthPlan& plan, int lobes,
                   SceneTables& out)
        : material_(material), model_(model), lobes_(lobes), out_(out), lanes_(plan, out.tables),
          optics_(material, model, plan), parts_(stack_parts(material)) {}

    void append() {
        record_.walk = NO_INDEX;
        record_.spectral = optics_.is_spectral() ? 1u : 0u;
        out_.features.spectral_stack |= optics_.is_spectral();
        note_thick_films();
        append_layers();
        choose_evaluation();
        append_lobes();
        append_stack();
        const LaneOperator substrate =
            append_substrate(material_, model_, optics_, lanes_, record_, out_);
        record_.choice = append_choice(optics_, substrate, lobes_, lanes_);
        out_.materials.push_back(record_);
    }

private:
    bool is_model_a() const { return model_ == Model::WeidlichWilkie; }

    /// A cubic between 65 nodes over the cosine's square root follows three fringes to 1 %.
    void note_thick_films() {
        constexpr double shortest_nm = 400.0, most_fringes = 3.0;
        for (const StackPart& part : parts_) {
            const std::optional<ThinFilm>& film = film_of(part);
            if (!film)
                continue;
            const double above = material_at(material_, shortest_nm).ior_below(part.slabs_above());
            const double inside = film->ior(shortest_nm);
            const double grazing = std::sqrt(std::max(inside * inside - above * above, 0.0));
            if (2.0 * film->thickness_nm * (inside - grazing) / shortest_nm > most_fringes)
                out_.notes.push_back(
                    fmt::format("material '{}': fringes of its film of {} nm are finer than the "
                                "tables of angles; measure resolves them",
                                material_.name, film->thickness_nm));
        }
    }

    const std::optional<ThinFilm>& film_of(const StackPart& part) const {
        switch (part.kind) {
        case StackPart::Kind::Interface:
            return material_.stack.layers[part.layer].film;
        case StackPart::Kind::Flakes:
            return material_.stack.layers[part.layer].flakes->reflector.film;
        case StackPart::Kind::Conductor:
            break;
        }
        return material_.substrate.conductor.film;
    }

    void append_layers() {
        record_.first_layer = static_cast<std::uint32_t>(out_.layers.size());
        const MaterialValues values = material_at(material_, reference_nm);
        record_.lowest_ior = static_cast<float>(values.ior_below(values.stack.size()));
        for (const StackPart& part : parts_) {
            LayerRecord layer{};
            layer.eta = 1.0f;
            layer.alpha = static_cast<float>(part.alpha);
            layer.distribution = static_cast<std::uint32_t>(kernel_distribution(part.distribution));
            layer.eta_lanes = NO_INDEX;
            layer.reflectance = NO_INDEX;
            if (part.kind == StackPart::Kind::Interface)
                layer.eta = static_cast<float>(values.ior_below(part.layer + 1) /
                                               values.ior_below(part.layer));
            if (part.kind == StackPart::Kind::Flakes)
                layer.coverage = static_cast<float>(values.stack[part.layer].flake_coverage);
            out_.layers.push_back(layer);
            record_.layer_count += part.kind == StackPart::Kind::Conductor ? 0u : 1u;
        }
        const bool has_top = !parts_.empty() && parts_.front().alpha > 0.0;
        record_.has_top_lobe = has_top ? 1u : 0u;
        out_.features.rough |= has_top;
    }

    LayerRecord& layer_record(std::size_t part) { return out_.layers[record_.first_layer + part]; }

    /// Chooses what the kernels evaluate for themselves, and whether lane by lane, and appends the
    /// tables that they need for it.
    void choose_evaluation() {
        const bool nested = is_model_a() && !is_all_smooth(material_);
        const bool dispersive = material_.stack.is_dispersive();
        record_.weidlich_wilkie = !nested ? 0u : dispersive ? MODEL_A_PER_LANE : MODEL_A;
        out_.features.weidlich_wilkie |= nested;
        if (nested && dispersive)
            append_ior_ratios(parts_.size());
        else if (record_.has_top_lobe != 0u && !material_.stack.layers.empty() &&
                 !material_.stack.layers.front().ior.is_constant())
            append_ior_ratios(1);
        for (std::size_t p = 0; nested && p < parts_.size(); ++p)
            if (is_tabulated(parts_[p]))
                append_reflectance(p);
    }

    /// IOR below over IOR above per lane, for the interfaces among the first `count` parts.
    void append_ior_ratios(std::size_t count) {
        out_.features.dispersion = true;
        for (std::size_t p = 0; p < count; ++p) {
            const std::size_t k = parts_[p].layer;
            layer_record(p).eta_lanes = lanes_.append_lanes([&](int phase, int lane) {
                if (parts_[p].kind != StackPart::Kind::Interface)
                    return 1.0;
                const double nm = lanes_.plan().wavelength_nm(lane, phase);
                const auto& layers = material_.stack.layers;
                return layers[k].ior(nm) / (k > 0 ? layers[k - 1].ior(nm) : 1.0);
            });
        }
    }

    /// Fresnel's bare dielectric is the only reflectance that kernels know by themselves.
    bool is_tabulated(const StackPart& part) const {
        return part.kind != StackPart::Kind::Interface ||
               (film_of(part) && film_of(part)->thickness_nm > 0.0);
    }

    void append_reflectance(std::size_t p) {
        out_.features.tabulated_reflectance = true;
        layer_record(p).reflectance =
            lanes_.append_nodes_of_lanes([&](double cosine, int phase, int lane) {
                return material_at(material_, lanes_.plan().wavelength_nm(lane, phase))
                    .facet_reflectance(parts_[p], cosine);
            });
    }

    void append_lobes() {
        const auto& shapes = optics_.any().deeper_lobes();
        const std::vector<DeeperLobe> lobes = is_model_a() ? weidlich_wilkie_lobes(material_)
                                                           : std::vector<DeeperLobe>(shapes.size());
        record_.first_lobe = static_cast<std::uint32_t>(out_.lobes.size());
        record_.lobe_count = static_cast<std::uint32_t>(lobes.size());
        for (std::size_t l = 0; l < lobes.size(); ++l) {
            LobeRecord lobe{static_cast<float>(shapes[l].alpha),
                            static_cast<std::uint32_t>(kernel_distribution(shapes[l].distribution)),
                            static_cast<std::uint32_t>(lobes[l].part), NO_INDEX};
            if (lobes[l].is_slab) {
                lobe.alpha = static_cast<float>(material_.stack.layers[lobes[l].layer].anisotropy);
                lobe.slab = append_slab(lobes[l].layer);
            }
            out_.lobes.push_back(lobe);
        }
        out_.features.deeper_lobes |= !lobes.empty();
        out_.features.scattering_slabs |= material_.stack.scatters();
    }

    /// [2][phase][lane]: optical depth, then the share of it that scatters.
    std::uint32_t append_slab(std::size_t layer) {
        const auto slab_at = [&](int phase, int lane) {
            return stack_at(material_.stack, lanes_.plan().wavelength_nm(lane, phase))[layer];
        };
        const std::uint32_t offset = lanes_.append_lanes([&](int phase, int lane) {
            const LayerValues slab = slab_at(phase, lane);
            return slab.tau + slab.tau_scattering;
        });
        lanes_.append_lanes([&](int phase, int lane) {
            const LayerValues slab = slab_at(phase, lane);
            const double tau = slab.tau + slab.tau_scattering;
            return tau > 0.0 ? slab.tau_scattering / tau : 0.0;
        });
        return offset;
    }

    using AngularValue = double (StackOptics::*)(double) const;

    /// [node] for a stack whose optics are grey, [phase][node][lane] for a spectral one.
    std::uint32_t append_nodes(const std::function<double(const StackOptics&, double)>& value) {
        if (!optics_.is_spectral())
            return lanes_.append_nodes([&](double c) { return value(optics_.any(), c); });
        return lanes_.append_nodes_of_lanes(
            [&](double c, int phase, int lane) { return value(optics_.at(phase, lane), c); });
    }

    std::uint32_t append_if_positive(AngularValue value) {
        return optics_.is_ever_positive(value) ? append_nodes(value) : NO_INDEX;
    }

    void append_stack() {
        record_.transmission = append_nodes(&StackOptics::transmission);
        record_.delta = append_if_positive(&StackOptics::delta);
        out_.features.smooth |= record_.delta != NO_INDEX;
        record_.residual = append_if_positive(&StackOptics::residual);
        record_.amplitude = NO_INDEX;
        for (std::uint32_t l = 0; l < record_.lobe_count; ++l) {
            const std::uint32_t offset = append_nodes([l](const StackOptics& o, double c) {
                return o.amplitude(static_cast<int>(l), c);
            });
            if (l == 0)
                record_.amplitude = offset;
        }
    }

    const Material& material_;
    Model model_;
    int lobes_;
    SceneTables& out_;
    LaneTables lanes_;
    MaterialOptics optics_;
    std::vector<StackPart> parts_;
    MaterialRecord record_{};
};

} // namespace

void append_material(const Material& material, Model model, const WavelengthPlan& plan, int lobes,
                     SceneTables& tables) {
    MaterialTables(material, model, plan, lobes, tables).append();
}

} // namespace reradiant
