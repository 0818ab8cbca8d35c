#pragma once

#include "host/render/tables/dyed_operator.h"
#include "host/render/tables/lane_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/substrate_operator.h"

#include <functional>

namespace reradiant {

/// Hemispherical share of uniform white light that leaves towards a node's direction by the diffuse
/// part, at a lane of the middle phase.
using DiffuseShare = std::function<double(int lane, int node)>;

/// Returns it for light that reached the substrate, from its operator at the middle phase, or that
/// dyes and substrate send out.
DiffuseShare substrate_share(const MaterialOptics& optics, const LaneOperator& substrate,
                             int phase);
DiffuseShare dyed_share(const ChannelOperator& dyes);

/// Appends [node][components + 1]: the cumulative probabilities with which a direction is sampled
/// from the mirror delta, the top lobe, `lobes` deeper ones (those that a material lacks stay
/// empty) and the cosine lobe, by the share of each in what is reflected, mean over lanes; then the
/// largest lane's albedo, by which paths survive Russian roulette.
std::uint32_t append_choice(const MaterialOptics& optics, const DiffuseShare& diffuse, int lobes,
                            LaneTables& lanes);

} // namespace reradiant
