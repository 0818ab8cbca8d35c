#pragma once

#include "host/render/dyes/dyed_operator.h"
#include "host/render/plan/render_features.h"
#include "host/render/tables/lane_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/substrate_operator.h"

#include <functional>

namespace reradiant {

/// Share of uniform white light from one hemisphere that leaves towards a node's direction by the
/// diffuse part, at a lane of the middle phase.
using DiffuseShare = std::function<double(int lane, int node)>;

/// Returns it for light that reached the substrate, from its operator at the middle phase, or that
/// dyes and substrate send out.
DiffuseShare substrate_share(const MaterialOptics& optics, const LaneOperator& substrate,
                             int phase);
/// The latter leaves a sheet on side `to`.
DiffuseShare dyed_share(const ChannelOperator& dyes, Side from, Side to);

/// Appends [node][components + 1]: the cumulative probabilities with which a direction is sampled
/// from the mirror delta, the top lobe, deeper ones (those that a material lacks stay empty) and
/// the cosine lobe, and where the scene has sheets from straight on, the lobe about that and a
/// cosine lobe on the far side, by the share of each in what leaves, mean over lanes; then the
/// largest lane's albedo, by which paths survive Russian roulette. `through` is what dyes send out
/// of light from a sheet's far side; empty: nothing.
std::uint32_t append_choice(const MaterialOptics& optics, const DiffuseShare& diffuse,
                            const DiffuseShare& through, const RenderFeatures& features,
                            LaneTables& lanes);

} // namespace reradiant
