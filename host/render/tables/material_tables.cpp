#include "host/render/tables/scene_tables.h"

#include "host/layers/models/weidlich_wilkie_bsdf.h"
#include "host/layers/rough/facet_reflectance.h"
#include "host/render/dyes/dyed_operator.h"
#include "host/render/plan/material_plan.h"
#include "host/render/tables/choice_tables.h"
#include "host/render/tables/substrate_tables.h"
#include "host/scene/model/closed_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace reradiant {

namespace {

/// Builds one material's records and tables, of a sheet for one side.
class MaterialTables {
public:
    MaterialTables(const Material& material, const MaterialPlan& plan,
                   const WavelengthPlan& wavelengths, const RenderFeatures& features,
                   MaterialOptics optics, SceneTables& out)
        : material_(material), plan_(plan), features_(features), out_(out),
          lanes_(wavelengths, out.tables), optics_(std::move(optics)),
          stack_(material_at(material, reference_nm, optics_.side())),
          parts_(reflecting_elements(stack_)) {}

    /// `above` is the record of a sheet seen from above, where this is the other side of it.
    void append(const MaterialRecord* above = nullptr) {
        record_.walk = NO_INDEX;
        record_.other_side = NO_INDEX;
        record_.spectral = optics_.is_spectral() ? 1u : 0u;
        note_thick_films();
        append_layers();
        append_evaluation();
        append_lobes();
        append_stack();
        const LaneOperator substrate = append_substrate(material_, plan_.choice.model, optics_,
                                                        *plan_.on_cells, lanes_, record_, out_);
        record_.dyes = record_.dyes_far = record_.dye_coupling = NO_INDEX;
        record_.through_delta = record_.through_ratio = NO_INDEX;
        record_.through_first = 0u;
        record_.through_lobe_own = record_.through_lobe_far = NO_INDEX;
        record_.through_own = record_.through_far = NO_INDEX;
        if (above)
            take_from_other_side(*above);
        else
            append_both_sides();
        append_choices(substrate);
        out_.materials.push_back(record_);
    }

private:
    bool is_model_a() const { return plan_.choice.model == Model::WeidlichWilkie; }

    /// A cubic between 65 nodes over the cosine's square root follows three fringes to 1 %.
    void note_thick_films() {
        constexpr double shortest_nm = 400.0, most_fringes = 3.0;
        for (const StackElement& element : material_at(material_, shortest_nm)) {
            const SurfaceValues* surface = surface_of(element);
            if (!surface || !surface->has_film())
                continue;
            const double above = surface->ior_above, inside = surface->film.ior;
            const double grazing = std::sqrt(std::max(inside * inside - above * above, 0.0));
            if (2.0 * surface->film.thickness_nm * (inside - grazing) / shortest_nm > most_fringes)
                out_.notes.push_back(
                    fmt::format("material '{}': fringes of its film of {} nm are finer than the "
                                "tables of angles; measure resolves them",
                                material_.name, surface->film.thickness_nm));
        }
    }

    /// The surface of a part: of the interfaces, sheets of flakes and the conductor, from the air
    /// down, which LayerRecords stand for.
    const SurfaceValues& part(std::size_t p) const { return *surface_of(stack_[parts_[p]]); }

    void append_layers() {
        record_.first_layer = static_cast<std::uint32_t>(out_.layers.size());
        record_.lowest_ior = static_cast<float>(lowest_ior(stack_));
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const SurfaceValues& surface = part(p);
            const auto* flakes = std::get_if<FlakesValues>(&stack_[parts_[p]]);
            LayerRecord layer{};
            layer.eta = 1.0f;
            layer.alpha = static_cast<float>(surface.alpha);
            layer.distribution =
                static_cast<std::uint32_t>(kernel_distribution(surface.distribution));
            layer.eta_lanes = NO_INDEX;
            layer.reflectance = NO_INDEX;
            if (!surface.is_conductor)
                layer.eta = static_cast<float>(surface.ior_below / surface.ior_above);
            if (flakes)
                layer.coverage = static_cast<float>(flakes->coverage);
            out_.layers.push_back(layer);
            record_.layer_count += &surface == conductor_of(stack_) ? 0u : 1u;
        }
        record_.has_top_lobe = !parts_.empty() && part(0).alpha > 0.0 ? 1u : 0u;
    }

    LayerRecord& layer_record(std::size_t p) { return out_.layers[record_.first_layer + p]; }

    /// Appends the tables that kernels need for what they evaluate for themselves.
    void append_evaluation() {
        record_.weidlich_wilkie = plan_.model_a;
        append_ior_ratios(plan_.ior_ratios);
        for (const std::size_t p : plan_.tabulated)
            append_reflectance(p);
    }

    /// IOR below over IOR above per lane, for the interfaces among the first `count` parts.
    void append_ior_ratios(std::size_t count) {
        for (std::size_t p = 0; p < count; ++p)
            layer_record(p).eta_lanes = lanes_.append_lanes([&](int phase, int lane) {
                if (part(p).is_conductor)
                    return 1.0;
                const StackElements stack = stack_in(phase, lane);
                const SurfaceValues& surface = *surface_of(stack[parts_[p]]);
                return surface.ior_below / surface.ior_above;
            });
    }

    StackElements stack_in(int phase, int lane) const {
        return material_at(material_, lanes_.plan().wavelength_nm(lane, phase), optics_.side());
    }

    void append_reflectance(std::size_t p) {
        layer_record(p).reflectance =
            lanes_.append_nodes_of_lanes([&](double cosine, int phase, int lane) {
                return facet_reflectance(*surface_of(stack_in(phase, lane)[parts_[p]]), cosine);
            });
    }

    void append_lobes() {
        const auto& shapes = optics_.any().deeper_lobes();
        const std::vector<DeeperLobe> lobes =
            is_model_a() ? weidlich_wilkie_lobes(stack_) : std::vector<DeeperLobe>(shapes.size());
        record_.first_lobe = static_cast<std::uint32_t>(out_.lobes.size());
        record_.lobe_count = static_cast<std::uint32_t>(lobes.size());
        for (std::size_t l = 0; l < lobes.size(); ++l) {
            LobeRecord lobe{static_cast<float>(shapes[l].alpha),
                            static_cast<std::uint32_t>(kernel_distribution(shapes[l].distribution)),
                            static_cast<std::uint32_t>(
                                is_model_a() ? lobes[l].part : parts_above(shapes[l].element)),
                            NO_INDEX,
                            NO_INDEX,
                            NO_INDEX,
                            0.0f};
            if (shapes[l].table)
                (shapes[l].is_between_facets() ? lobe.shape : lobe.ratio) =
                    lanes_.append_numbers(*shapes[l].table);
            if (lobe.ratio != NO_INDEX)
                lobe.ratio_width = static_cast<float>(sampling_width(shapes[l], 1.0));
            const auto* slab = std::get_if<SlabValues>(&stack_[lobes[l].element]);
            if (is_model_a() && slab) {
                lobe.alpha = static_cast<float>(slab->anisotropy);
                lobe.slab = append_slab(lobes[l].element);
            }
            out_.lobes.push_back(lobe);
        }
    }

    /// Number of parts that lie above an element.
    std::size_t parts_above(std::size_t element) const {
        return static_cast<std::size_t>(std::lower_bound(parts_.begin(), parts_.end(), element) -
                                        parts_.begin());
    }

    /// [2][phase][lane]: optical depth, then the share of it that scatters.
    std::uint32_t append_slab(std::size_t element) {
        const auto slab_in = [&](int phase, int lane) {
            return std::get<SlabValues>(stack_in(phase, lane)[element]);
        };
        const std::uint32_t offset =
            lanes_.append_lanes([&](int phase, int lane) { return slab_in(phase, lane).depth(); });
        lanes_.append_lanes([&](int phase, int lane) {
            const SlabValues slab = slab_in(phase, lane);
            return slab.depth() > 0.0 ? slab.tau_scattering / slab.depth() : 0.0;
        });
        return offset;
    }

    /// [node] for a stack whose optics are grey, [phase][node][lane] for a spectral one.
    std::uint32_t append_nodes(const std::function<double(const StackBsdf&, double)>& value) {
        return append_cosines([&] { return [&](double c) { return value(optics_.any(), c); }; },
                              [&](int phase, int lane) {
                                  return [&, phase, lane](double c) {
                                      return value(optics_.at(phase, lane), c);
                                  };
                              });
    }

    /// `grey` and `spectral` return functions of the cosine: of any wavelength, and of a lane's.
    template <typename Grey, typename Spectral>
    std::uint32_t append_cosines(const Grey& grey, const Spectral& spectral) {
        if (!optics_.is_spectral())
            return lanes_.append_nodes(grey());
        return lanes_.append_nodes_of_lanes(
            [&](double c, int phase, int lane) { return spectral(phase, lane)(c); });
    }

    void append_choices(const LaneOperator& substrate) {
        const int phase = lanes_.phases() / 2;
        const Side own = optics_.side();
        if (!plan_.dyes) {
            record_.choice = append_choice(optics_, substrate_share(optics_, substrate, phase), {},
                                           features_, lanes_);
            return;
        }
        const ChannelOperator& dyes = plan_.dyes->phases[static_cast<std::size_t>(phase)];
        const DiffuseShare through =
            optics_.is_sheet() ? dyed_share(dyes, opposite(own), own) : DiffuseShare{};
        record_.choice =
            append_choice(optics_, dyed_share(dyes, own, own), through, features_, lanes_);
    }

    /// The tables that both sides of a sheet share, or the one side that there is.
    void append_both_sides() {
        if (plan_.dyes)
            append_dyes(*plan_.dyes);
        if (optics_.is_sheet())
            append_through();
    }

    void take_from_other_side(const MaterialRecord& above) {
        record_.dyes = above.dyes_far;
        record_.dyes_far = above.dyes;
        record_.dye_coupling = above.dye_coupling;
        record_.dye_channels = above.dye_channels;
        record_.dyes_shift_up = above.dyes_shift_up;
        record_.dye_terms = above.dye_terms;
        record_.through_delta = above.through_delta;
        record_.through_lobe_own = above.through_lobe_far;
        record_.through_lobe_far = above.through_lobe_own;
        record_.through_ratio = above.through_ratio;
        record_.through_width = above.through_width;
        record_.through_first = 1u - above.through_first;
        record_.through_own = above.through_far;
        record_.through_far = above.through_own;
    }

    void append_through_ratio() {
        const LobeShape& lobe = optics_.any_sheet().lobe(Side::Above);
        record_.through_first = lobe.table_kind == LobeShape::Table::OwnFirst ? 1u : 0u;
        record_.through_width = static_cast<float>(sampling_width(lobe, 1.0));
        record_.through_ratio = lanes_.append_numbers(*lobe.table);
    }

    void append_through() {
        const auto nodes = [&](const auto& value) {
            return append_cosines(
                [&] { return value(optics_.any_sheet()); },
                [&](int phase, int lane) { return value(optics_.sheet_at(phase, lane)); });
        };
        const auto lobe = [&](Side side) {
            return nodes([side](const SheetTransmission& sheet) {
                return [&sheet, side](double c) { return sheet.lobe_amplitude(c, side); };
            });
        };
        if (optics_.any_sheet().has_lobe()) {
            record_.through_lobe_own = lobe(Side::Above);
            record_.through_lobe_far = lobe(Side::Below);
            append_through_ratio();
        } else {
            record_.through_delta = nodes([](const SheetTransmission& sheet) {
                return [&sheet](double c) { return sheet.delta(c); };
            });
            if (!material_.stack.scatters())
                return;
        }
        const auto product = [&](Side side) {
            return nodes([side](const SheetTransmission& sheet) {
                return [&sheet, side](double c) { return sheet.product_amplitude(c, side); };
            });
        };
        record_.through_own = product(Side::Above);
        record_.through_far = product(Side::Below);
    }

    /// What dyes and the substrate beneath them send out: it stands instead of the substrate's
    /// operator, which no kernel asks for then.
    void append_dyes(const DyedOperator& dyes) {
        record_.dye_channels = static_cast<std::uint32_t>(dyes.channels);
        record_.dyes_shift_up = dyes.shifts_up ? 1u : 0u;
        record_.dye_terms = static_cast<std::uint32_t>(dyes.terms);
        record_.dyes = append_channels(dyes, Side::Above);
        if (optics_.is_sheet())
            record_.dyes_far = append_channels(dyes, Side::Below);
        append_dye_coupling(dyes);
        out_.notes.push_back(fmt::format(
            "material '{}': dyes in {} depth cells (error {:.1g}), {} functions of the direction "
            "(error {:.1g}), {}",
            material_.name, dyes.cells, dyes.depth_error, dyes.channels, dyes.channel_error,
            dyes.terms > 0 ? fmt::format("{} products of an emission and an excitation (error "
                                         "{:.1g})",
                                         dyes.terms, dyes.factor_error)
                           : std::string("entry by entry")));
    }

    /// Rows of lanes; terms that a phase does not need are 0.
    void append_dye_factors(const ChannelFactors& factors, int channels, int terms) {
        const int lanes = lanes_.lanes();
        const auto append_row = [&](const auto& value) {
            for (int lane = 0; lane < lanes_.padded_lanes(); ++lane)
                lanes_.append(lane < lanes ? value(lane) : 0.0);
        };
        for (Eigen::Index row = 0; row < factors.within.rows(); ++row)
            append_row([&](int lane) { return factors.within(row, lane); });
        for (int term = 0; term < terms; ++term)
            for (const Eigen::MatrixXd* own : {&factors.taken, &factors.sent})
                for (int channel = 0; channel < channels; ++channel)
                    append_row([&](int lane) {
                        return term < own->cols() ? (*own)(channel * lanes + lane, term) : 0.0;
                    });
    }

    std::uint32_t append_channels(const DyedOperator& dyes, Side side) {
        const std::uint32_t offset = lanes_.here();
        for (int channel = 0; channel < dyes.channels; ++channel)
            lanes_.append_table([&](int node, int phase, int lane) {
                return dyes.reached(phase, lane, node, channel, side);
            });
        return offset;
    }

    void append_dye_coupling(const DyedOperator& dyes) {
        record_.dye_coupling = lanes_.here();
        const int lanes = lanes_.lanes(), padded = lanes_.padded_lanes();
        if (dyes.terms > 0) {
            for (const ChannelOperator& phase : dyes.phases)
                append_dye_factors(phase.factors, dyes.channels, dyes.terms);
            return;
        }
        for (const ChannelOperator& phase : dyes.phases)
            for (int a = 0; a < dyes.channels; ++a)
                for (int i = 0; i < padded; ++i)
                    for (int b = 0; b < dyes.channels; ++b)
                        for (int o = 0; o < padded; ++o)
                            lanes_.append(i < lanes && o < lanes
                                              ? phase.coupling(b * lanes + o, a * lanes + i)
                                              : 0.0);
    }

    void append_stack() {
        record_.transmission = append_nodes(&StackBsdf::transmission);
        record_.delta = plan_.has_delta ? append_nodes(&StackBsdf::delta) : NO_INDEX;
        record_.residual =
            plan_.has_residual ? append_nodes(&StackBsdf::residual_amplitude) : NO_INDEX;
        record_.amplitude = NO_INDEX;
        for (std::uint32_t l = 0; l < record_.lobe_count; ++l) {
            const std::uint32_t offset = append_nodes([l](const StackBsdf& o, double c) {
                return o.lobe_amplitude(static_cast<int>(l), c);
            });
            if (l == 0)
                record_.amplitude = offset;
        }
    }

    const Material& material_;
    const MaterialPlan& plan_;
    const RenderFeatures& features_;
    SceneTables& out_;
    LaneTables lanes_;
    MaterialOptics optics_;
    StackElements stack_;            ///< at the reference wavelength
    std::vector<std::size_t> parts_; ///< elements that reflect
    MaterialRecord record_{};
};

} // namespace

void append_material(const Material& material, const MaterialPlan& plan,
                     const WavelengthPlan& wavelengths, const RenderFeatures& features,
                     const MaterialOptics& optics, SceneTables& tables) {
    MaterialTables(material, plan, wavelengths, features, optics, tables).append();
}

void append_other_side(const Material& material, const MaterialPlan& plan,
                       const WavelengthPlan& wavelengths, const RenderFeatures& features,
                       const MaterialOptics& optics, std::size_t above, SceneTables& tables) {
    const MaterialRecord record = tables.materials[above];
    MaterialTables(material, plan, wavelengths, features, optics.seen_from(Side::Below), tables)
        .append(&record);
    tables.materials[above].other_side = static_cast<std::uint32_t>(tables.materials.size() - 1);
    tables.materials.back().other_side = static_cast<std::uint32_t>(above);
}

} // namespace reradiant
