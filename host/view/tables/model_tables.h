#pragma once

#include "host/view/tables/variant_grid.h"

#include <nlohmann/json.hpp>

namespace reradiant {

/// Tables of `adding` for every variant of a material that it knows, as JSON for the page's script
/// (host/view/page/tables.js). A variant's functions of the cosine in air stand at the nodes of
/// CosineTable: the logarithm of the transmission, the mirror's weight, the residual, the specular
/// albedo, then the amplitudes of the lobes.
nlohmann::ordered_json adding_tables(const Material& material, const WavelengthGrid& bands,
                                     bool with_sliders);

/// Tables of `weidlich-wilkie` likewise: the residual alone, as all else is in closed form. Null
/// where no surface is rough.
nlohmann::ordered_json weidlich_wilkie_tables(const Material& material, const WavelengthGrid& bands,
                                              bool with_sliders);

/// Numbers as base64 of little-endian 32-bit floats, of which all first bytes stand before all
/// second ones and so on: so that they pack well (host/view/page/start.js).
std::string encoded_floats(const std::vector<double>& values);

} // namespace reradiant
