#include "host/render/plan/material_plan.h"
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
    MaterialTables(const Material& material, const MaterialPlan& plan,
                   const WavelengthPlan& wavelengths, int lobes, SceneTables& out)
        : material_(material), plan_(plan), lobes_(lobes), out_(out),
          lanes_(wavelengths, out.tables), optics_(material, plan.choice.model, wavelengths),
          parts_(stack_parts(material)) {}

    void append() {
        record_.walk = NO_INDEX;
        record_.spectral = optics_.is_spectral() ? 1u : 0u;
        note_thick_films();
        append_layers();
        append_evaluation();
        append_lobes();
        append_stack();
        const LaneOperator substrate = append_substrate(material_, plan_.choice.model, optics_,
                                                        *plan_.on_cells, lanes_, record_, out_);
        record_.choice = append_choice(optics_, substrate, lobes_, lanes_);
        out_.materials.push_back(record_);
    }

private:
    bool is_model_a() const { return plan_.choice.model == Model::WeidlichWilkie; }

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
        record_.has_top_lobe = plan_.features.rough ? 1u : 0u;
    }

    LayerRecord& layer_record(std::size_t part) { return out_.layers[record_.first_layer + part]; }

    /// Appends the tables that kernels need for what they evaluate for themselves.
    void append_evaluation() {
        record_.weidlich_wilkie = plan_.model_a;
        append_ior_ratios(plan_.ior_ratios);
        for (const std::size_t p : plan_.tabulated)
            append_reflectance(p);
    }

    /// IOR below over IOR above per lane, for the interfaces among the first `count` parts.
    void append_ior_ratios(std::size_t count) {
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

    void append_reflectance(std::size_t p) {
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

    /// [node] for a stack whose optics are grey, [phase][node][lane] for a spectral one.
    std::uint32_t append_nodes(const std::function<double(const StackOptics&, double)>& value) {
        if (!optics_.is_spectral())
            return lanes_.append_nodes([&](double c) { return value(optics_.any(), c); });
        return lanes_.append_nodes_of_lanes(
            [&](double c, int phase, int lane) { return value(optics_.at(phase, lane), c); });
    }

    void append_stack() {
        record_.transmission = append_nodes(&StackOptics::transmission);
        record_.delta = plan_.has_delta ? append_nodes(&StackOptics::delta) : NO_INDEX;
        record_.residual = plan_.has_residual ? append_nodes(&StackOptics::residual) : NO_INDEX;
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
    const MaterialPlan& plan_;
    int lobes_;
    SceneTables& out_;
    LaneTables lanes_;
    MaterialOptics optics_;
    std::vector<StackPart> parts_;
    MaterialRecord record_{};
};

} // namespace

void append_material(const Material& material, const MaterialPlan& plan,
                     const WavelengthPlan& wavelengths, int lobes, SceneTables& tables) {
    MaterialTables(material, plan, wavelengths, lobes, tables).append();
}

} // namespace reradiant
