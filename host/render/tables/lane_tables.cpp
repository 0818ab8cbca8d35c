#include "host/render/tables/lane_tables.h"

#include "kernels/core/shared.h"

#include <tbb/parallel_for.h>

namespace reradiant {

double node_cosine(int node) {
    const double u = static_cast<double>(node) / (TABLE_NODES - 1);
    return u * u;
}

std::uint32_t LaneTables::append_lanes(const std::function<double(int phase, int lane)>& value) {
    const std::uint32_t offset = here();
    for (int phase = 0; phase < phases(); ++phase)
        for (int lane = 0; lane < padded_; ++lane)
            append(lane < lanes_ ? value(phase, lane) : 0.0);
    return offset;
}

std::uint32_t LaneTables::append_nodes(const std::function<double(double cosine)>& value) {
    const std::uint32_t offset = here();
    for (int node = 0; node < TABLE_NODES; ++node)
        append(value(node_cosine(node)));
    return offset;
}

std::uint32_t LaneTables::append_nodes_of_lanes(
    const std::function<double(double cosine, int phase, int lane)>& value) {
    return append_table(
        [&](int node, int phase, int lane) { return value(node_cosine(node), phase, lane); });
}

std::uint32_t
LaneTables::append_table(const std::function<double(int node, int phase, int lane)>& value) {
    const std::uint32_t offset = here();
    const int rows = phases() * TABLE_NODES;
    tables_.resize(tables_.size() +
                   static_cast<std::size_t>(rows) * static_cast<std::size_t>(padded_));
    float* table = tables_.data() + offset;
    tbb::parallel_for(0, rows, [&](int row) {
        for (int lane = 0; lane < lanes_; ++lane)
            table[row * padded_ + lane] =
                static_cast<float>(value(row % TABLE_NODES, row / TABLE_NODES, lane));
    });
    return offset;
}

} // namespace reradiant
