#include "host/render/dyes/dyed_operator.h"

#include "host/render/dyes/dyed_file.h"
#include "host/render/dyes/dyed_key.h"
#include "host/render/tables/lane_tables.h"
#include "host/render/tables/substrate_operator.h"
#include "host/scene/model/closed_model.h"
#include "host/spectral/matrix/singular_values.h"
#include "kernels/core/shared.h"
#include "reradiant/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

constexpr int most_channels = 4;
/// Share of what reaches the cells that channels may leave out.
constexpr double channel_tolerance = 1e-3;
/// Most terms that a coupling is applied by; beyond that entry by entry costs no more.
constexpr int most_terms = 8;
/// What of the light between lanes the terms may leave out.
constexpr double factor_tolerance = 5e-4;

/// What reaches the sources at the nodes of the tables: (TABLE_NODES, sources), twice as many rows
/// for a sheet.
Eigen::MatrixXd reached_at_nodes(const SourceTransport& transport, bool is_sheet) {
    Eigen::MatrixXd reached((is_sheet ? 2 : 1) * TABLE_NODES, transport.sources());
    for (int node = 0; node < TABLE_NODES; ++node)
        for (const Side side : {Side::Above, Side::Below})
            if (side == Side::Above || is_sheet)
                reached.row(node_row(node, side)) =
                    transport.reached(node_cosine(node), side).transpose();
    return reached;
}

/// Square roots of the nodes' shares of a uniform radiance's flux, for so many rows.
Eigen::VectorXd root_weights(Eigen::Index rows) {
    Eigen::VectorXd weights(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
        const int node = static_cast<int>(row) % TABLE_NODES;
        const double low = node_cosine(std::max(node - 1, 0));
        const double high = node_cosine(std::min(node + 1, TABLE_NODES - 1));
        weights(row) = std::sqrt(0.5 * (high - low) * (high + low));
    }
    return weights;
}

/// The channels of one wavelength: functions of the direction, and how they make up what reaches
/// the sources, with fine and with coarse cells: (channels, sources).
struct Channels {
    Eigen::MatrixXd functions, fine, coarse;
};

/// Sources by their share of the emission: those of thin cells count less.
Eigen::VectorXd source_scales(const StackCells& cells, Eigen::Index sources) {
    Eigen::VectorXd scales = Eigen::VectorXd::Ones(sources);
    Eigen::Index source = 0;
    for (const DepthCells& slab : cells)
        for (int cell = 0; cell < slab.count(); ++cell)
            scales(source++) = slab.share(cell);
    return scales;
}

/// Decomposes what reaches the sources of one wavelength. `left_out` receives, by number of
/// channels from 1 on, the share that they do not hold.
ThinSvd decompose(const Eigen::MatrixXd& reached, const Eigen::VectorXd& scales,
                  std::vector<double>& left_out) {
    const ThinSvd svd =
        thin_svd(root_weights(reached.rows()).asDiagonal() * reached * scales.asDiagonal());
    const double whole = svd.s.norm();
    for (int channels = 1; channels <= most_channels; ++channels) {
        const Eigen::Index rest = std::max<Eigen::Index>(svd.s.size() - channels, 0);
        const double share = whole > 0.0 ? svd.s.tail(rest).norm() / whole : 0.0;
        double& largest = left_out[static_cast<std::size_t>(channels - 1)];
        largest = std::max(largest, share);
    }
    return svd;
}

/// Operators of all phases, phase by phase: first what reaches the sources is looked at everywhere,
/// then as many channels are made as that takes.
class DyedOperators {
public:
    /// `by_phase` is all that they depend on.
    explicit DyedOperators(const std::vector<DyedStack>& by_phase)
        : phases_(by_phase), is_sheet_(by_phase.front().substrate.size() == 0) {}

    DyedOperator make() {
        DyedOperator result;
        std::vector<double> left_out(most_channels, 0.0);
        for (const DyedStack& phase : phases_) {
            stacks_.push_back(stacks_.empty() ? std::make_unique<EmittingStack>(phase)
                                              : std::make_unique<EmittingStack>(
                                                    phase, stacks_.front()->cells_per_octave()));
            result.cells = std::max(result.cells, stacks_.back()->cells());
            result.depth_error = std::max(result.depth_error, stacks_.back()->error());
            add_reached(left_out);
        }
        result.channels = 1;
        while (result.channels < most_channels &&
               left_out[static_cast<std::size_t>(result.channels - 1)] > channel_tolerance)
            ++result.channels;
        result.channel_error = left_out[static_cast<std::size_t>(result.channels - 1)];
        for (std::size_t phase = 0; phase < phases_.size(); ++phase) {
            result.phases.push_back(at_phase(phase, result.channels));
            result.shifts_up = result.shifts_up && stacks_[phase]->shifts_up();
        }
        if (result.shifts_up)
            factorise(result);
        return result;
    }

private:
    /// Factors of all phases, or of none.
    static void factorise(DyedOperator& dyes) {
        tbb::parallel_for(std::size_t{0}, dyes.phases.size(), [&](std::size_t phase) {
            ChannelOperator& own = dyes.phases[phase];
            own.factors =
                factorise_channels(own.coupling, static_cast<Eigen::Index>(own.reached.size()),
                                   most_terms, factor_tolerance);
        });
        for (const ChannelOperator& phase : dyes.phases) {
            dyes.terms = std::max(dyes.terms, static_cast<int>(phase.factors.terms()));
            dyes.factor_error = std::max(dyes.factor_error, phase.factors.error);
        }
        if (dyes.factor_error > factor_tolerance)
            dyes.terms = 0;
        for (std::size_t phase = 0; phase < dyes.phases.size() && dyes.terms > 0; ++phase)
            if (phase != dyes.phases.size() / 2)
                dyes.phases[phase].coupling.resize(0, 0);
    }

    void add_reached(std::vector<double>& left_out) {
        const EmittingStack& stack = *stacks_.back();
        std::vector<Lane>& lanes = by_phase_.emplace_back(static_cast<std::size_t>(stack.bands()));
        std::vector<std::vector<double>> shares(lanes.size(), left_out);
        tbb::parallel_for(std::size_t{0}, lanes.size(), [&](std::size_t lane) {
            const auto band = static_cast<Eigen::Index>(lane);
            const SourceTransport& fine = stack.fine().at(band);
            const Eigen::VectorXd scales = source_scales(stack.fine_cells(), fine.sources());
            lanes[lane] = {decompose(reached_at_nodes(fine, is_sheet_), scales, shares[lane]),
                           scales, reached_at_nodes(stack.coarse().at(band), is_sheet_)};
        });
        for (const std::vector<double>& own : shares)
            for (std::size_t k = 0; k < left_out.size(); ++k)
                left_out[k] = std::max(left_out[k], own[k]);
    }

    struct Lane {
        ThinSvd svd;
        Eigen::VectorXd scales;
        Eigen::MatrixXd coarse; ///< what reaches coarse cells, (TABLE_NODES, sources)
    };

    Channels channels_of(const Lane& lane, int count) const {
        const Eigen::Index m = std::min<Eigen::Index>(count, lane.svd.s.size());
        const Eigen::VectorXd weights = root_weights(lane.svd.u.rows());
        Channels channels;
        const Eigen::MatrixXd u = lane.svd.u.leftCols(m);
        channels.functions = weights.cwiseInverse().asDiagonal() * u;
        channels.fine = lane.svd.s.head(m).asDiagonal() * lane.svd.v.leftCols(m).transpose() *
                        lane.scales.cwiseInverse().asDiagonal();
        channels.coarse = u.transpose() * weights.asDiagonal() * lane.coarse;
        return channels;
    }

    ChannelOperator at_phase(std::size_t phase, int count) const {
        const EmittingStack& stack = *stacks_[phase];
        const Eigen::Index lanes = stack.bands();
        std::vector<Channels> channels;
        for (const Lane& lane : by_phase_[phase])
            channels.push_back(channels_of(lane, count));
        ChannelOperator result;
        for (const Channels& own : channels)
            result.reached.push_back(own.functions);
        result.coupling.setZero(count * lanes, count * lanes);
        tbb::parallel_for(Eigen::Index{0}, count * lanes, [&](Eigen::Index column) {
            const Eigen::Index a = column / lanes, i = column % lanes;
            const Channels& own = channels[static_cast<std::size_t>(i)];
            if (a >= own.functions.cols())
                return;
            const Eigen::MatrixXd fine = stack.fine().sent(i, own.fine.row(a).transpose());
            const Eigen::MatrixXd coarse = stack.coarse().sent(i, own.coarse.row(a).transpose());
            for (Eigen::Index o = 0; o < lanes; ++o) {
                const Channels& to = channels[static_cast<std::size_t>(o)];
                const Eigen::VectorXd sent =
                    (4.0 * to.fine * fine.col(o).cwiseQuotient(stack.fine().at(o).weights()) -
                     to.coarse * coarse.col(o).cwiseQuotient(stack.coarse().at(o).weights())) *
                    (std::numbers::inv_pi / 3.0);
                for (Eigen::Index b = 0; b < sent.size(); ++b)
                    result.coupling(b * lanes + o, column) = sent(b);
            }
        });
        return result;
    }

    const std::vector<DyedStack>& phases_;
    bool is_sheet_;
    std::vector<std::unique_ptr<EmittingStack>> stacks_; ///< by phase
    std::vector<std::vector<Lane>> by_phase_;
};

/// What a material's dyes are computed from, by phase.
std::vector<DyedStack> dyed_stacks(const Material& material, const SubstrateOnCells& on_cells,
                                   const WavelengthPlan& plan) {
    std::vector<DyedStack> by_phase(static_cast<std::size_t>(plan.phases));
    for (const Layer& layer : material.stack.layers) {
        const std::vector<Eigen::MatrixXd> dyes = dyes_on_lanes(layer, plan);
        for (std::size_t phase = 0; phase < dyes.size(); ++phase)
            by_phase[phase].slabs.push_back(dyes[phase]);
    }
    for (int phase = 0; phase < plan.phases; ++phase) {
        DyedStack& stack = by_phase[static_cast<std::size_t>(phase)];
        for (int lane = 0; lane < static_cast<int>(plan.lanes.size()); ++lane)
            stack.by_band.push_back(material_at(material, plan.wavelength_nm(lane, phase)));
        if (!material.stack.is_sheet())
            stack.substrate = substrate_on_lanes(material.substrate, on_cells, plan, phase);
    }
    return by_phase;
}

} // namespace

Eigen::Index node_row(int node, Side side) {
    return node + (side == Side::Above ? 0 : TABLE_NODES);
}

DyedOperator dyed_operator(const Material& material, const SubstrateOnCells& on_cells,
                           const WavelengthPlan& plan) {
    const std::vector<DyedStack> by_phase = dyed_stacks(material, on_cells, plan);
    const std::string key = dyed_key(by_phase);
    if (std::optional<DyedOperator> kept = read_dyed_file(key))
        return std::move(*kept);
    DyedOperator made = DyedOperators(by_phase).make();
    keep_dyed_operator(key, made);
    return made;
}

} // namespace reradiant
