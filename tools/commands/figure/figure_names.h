#pragma once

#include "host/scene/document/table_reader.h"
#include "tools/commands/figure/figure_request.h"

#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// The names that a figure's file gives to panels and marks, and what they stand for. Every input
/// Error is placed at the name.
class FigureNames {
public:
    /// Refuses a name that is taken or empty.
    void add(const std::string& name, PanelReference::Kind kind, std::size_t index,
             const SourcePosition& position);
    /// Makes the marks of all images known as IMAGE.MARK; refuses a name that an image has twice.
    void add_marks(const FigureRequest& request);

    /// The marks that an array names; all of the figure where the key is absent.
    std::vector<MarkReference> marks(const TableReader& reader, const std::string& key) const;
    std::optional<MarkReference> mark_or_none(const TableReader& reader,
                                              const std::string& key) const;
    /// The panels that `rows` of the figure's head names; where it is absent, all images in a row,
    /// and beneath them all plots and swatches.
    std::vector<std::vector<PanelReference>> rows(const TableReader& head,
                                                  const FigureRequest& request) const;

private:
    PanelReference panel(const toml::node& node, const SourcePosition& position) const;
    MarkReference mark(const std::string& name, const SourcePosition& position) const;

    std::map<std::string, PanelReference> panels_;
    std::map<std::string, MarkReference> marks_;
    std::vector<MarkReference> all_marks_;
};

/// Pixels that a key of 2 (X, Y) or 4 (X0, Y0, X1, Y1) integers names.
ImageRegion region_at(const TableReader& reader, const std::string& key, std::size_t count);
/// Moves all sides of a region outwards.
void widen(ImageRegion& region, int pixels);

} // namespace reradiant
