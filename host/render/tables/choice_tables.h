#pragma once

#include "host/render/tables/lane_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/substrate_operator.h"

namespace reradiant {

/// Appends [node][components + 1]: the cumulative probabilities with which a direction is sampled
/// from the mirror delta, the top lobe, `lobes` deeper ones (those that a material lacks stay
/// empty) and the cosine lobe, by the share of each in what is reflected, mean over lanes; then the
/// largest lane's albedo, by which paths survive Russian roulette. `substrate`: its operator at the
/// middle phase.
std::uint32_t append_choice(const MaterialOptics& optics, const LaneOperator& substrate, int lobes,
                            LaneTables& lanes);

} // namespace reradiant
