#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <list>
#include <vector>

namespace reradiant {

/// The files whose materials and textures belong to a scene: its own, and those that the key
/// `include` names, which may include others. A file that is named twice is read once; input Error
/// at the key where a file includes itself by way of others.
class IncludedFiles {
public:
    /// `root` must outlive this.
    IncludedFiles(const TableReader& root, LoadState& state);

    /// The scene first, then the others in the order in which they are named.
    const std::vector<TableReader>& readers() const { return readers_; }

private:
    void include_from(const TableReader& reader, LoadState& state);

    std::list<toml::table> tables_; ///< that the readers read
    std::vector<TableReader> readers_;
    std::vector<std::filesystem::path> open_, read_;
};

} // namespace reradiant
