#pragma once

#include "host/render/tables/scene_tables.h"
#include "host/render/tables/stack_optics.h"
#include "host/render/tables/substrate_operator.h"

namespace reradiant {

/// Appends the operator of a material's substrate, `on_cells`, under its stack and sets its offsets
/// in the record and the notes. Returns the operator at the middle phase, for choosing among
/// components.
LaneOperator append_substrate(const Material& material, Model model, const MaterialOptics& optics,
                              const SubstrateOnCells& on_cells, LaneTables& lanes,
                              MaterialRecord& record, SceneTables& out);

} // namespace reradiant
