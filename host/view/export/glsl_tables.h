#pragma once

#include "host/view/material_data.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace reradiant {

/// What the functions of material.glsl and its sibling of a model read: names with numbers, rows of
/// numbers by band, and tables over the cosine.
struct GlslTables {
    Model model = Model::Adding;
    WavelengthGrid bands;
    std::vector<std::pair<std::string, int>> defines;
    /// Declarations of constants, in GLSL.
    std::vector<std::string> constants;
    std::vector<std::vector<double>> rows;                ///< (row, band)
    std::vector<std::vector<std::vector<double>>> tables; ///< (table, band, node)
    std::vector<std::string> left_out;
};

/// Nodes of a table over the cosine, uniform in its square root.
inline constexpr int glsl_nodes = 33;

/// Makes them of a material as it is, by its first model on a page.
GlslTables glsl_tables(const Material& material);

} // namespace reradiant
