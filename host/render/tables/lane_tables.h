#pragma once

#include "reradiant/wavelength_plan.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace reradiant {

/// Cosine of a table's node, 0 <= node < TABLE_NODES (kernels/core/table.h).
double node_cosine(int node);

/// Appends tables over a plan's lanes to a scene's floats. Lanes beyond the last are 0. Each
/// function returns the offset of what it appended.
class LaneTables {
public:
    LaneTables(const WavelengthPlan& plan, std::vector<float>& tables)
        : plan_(plan), tables_(tables), lanes_(static_cast<int>(plan.lanes.size())),
          padded_(plan.padded_lanes()) {}

    const WavelengthPlan& plan() const { return plan_; }
    int phases() const { return plan_.phases; }
    int lanes() const { return lanes_; }
    int padded_lanes() const { return padded_; }
    std::uint32_t here() const { return static_cast<std::uint32_t>(tables_.size()); }
    void append(double value) { tables_.push_back(static_cast<float>(value)); }

    std::uint32_t append_numbers(const std::vector<float>& numbers) {
        const std::uint32_t offset = here();
        tables_.insert(tables_.end(), numbers.begin(), numbers.end());
        return offset;
    }

    /// [phase][lane]
    std::uint32_t append_lanes(const std::function<double(int phase, int lane)>& value);
    /// [node]
    std::uint32_t append_nodes(const std::function<double(double cosine)>& value);
    /// [phase][node][lane], `value` is called from several threads.
    std::uint32_t
    append_nodes_of_lanes(const std::function<double(double cosine, int phase, int lane)>& value);
    /// The same of a function of the node's number.
    std::uint32_t append_table(const std::function<double(int node, int phase, int lane)>& value);

private:
    const WavelengthPlan& plan_;
    std::vector<float>& tables_;
    int lanes_, padded_;
};

} // namespace reradiant
