#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <string>
#include <vector>

namespace reradiant {

/// What a fluorophore sends out of the photons that it absorbs.
struct FluorescentBand {
    Spectrum emission; ///< relative radiant power per nm
    double quantum_yield = 1.0;
};

/// Reads the keys `emission` and `quantum_yield` of a table. Input Error at `emission` for one that
/// is zero from 200 to 1000 nm; `what` is what the message calls the owner, such as "dye".
FluorescentBand read_fluorescent_band(const TableReader& reader, const std::string& what,
                                      LoadState& state);

/// Reads the [[material.layer.fluorophores]] of a layer, the dyes in its slab. Shares are checked
/// as a substrate's matrix is; a dye that sends out nothing of what it absorbs is warned of.
std::vector<SlabDye> read_slab_dyes(const TableReader& layer, LoadState& state);

} // namespace reradiant
