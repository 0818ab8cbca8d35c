#include "tools/commands/figure/figure_names.h"

#include "host/scene/document/toml_document.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

template <typename Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& named) {
    std::vector<std::string> names;
    for (const auto& [name, value] : named)
        names.push_back(name);
    return names;
}

std::string text_at(const toml::node& node, const SourcePosition& position, const char* what) {
    if (!node.is_string())
        throw_input_error(position, fmt::format("{} is named by a text", what),
                          "write the name in quotes");
    return *node.value<std::string>();
}

const toml::array& array_at(const toml::node& node, const SourcePosition& position,
                            const char* form) {
    const toml::array* const array = node.as_array();
    if (array == nullptr || array->empty())
        throw_input_error(position, "is no list, or an empty one", form);
    return *array;
}

} // namespace

void FigureNames::add(const std::string& name, PanelReference::Kind kind, std::size_t index,
                      const SourcePosition& position) {
    if (name.empty())
        throw_input_error(position, "the name is empty", "give every panel a name");
    if (!panels_.emplace(name, PanelReference{kind, index}).second)
        throw_input_error(position, fmt::format("\"{}\" is the name of another panel", name),
                          "give every panel a name of its own");
}

void FigureNames::add_marks(const FigureRequest& request) {
    for (std::size_t image = 0; image < request.images.size(); ++image)
        for (std::size_t k = 0; k < request.images[image].marks.size(); ++k) {
            const MarkRequest& mark = request.images[image].marks[k];
            const std::string name = request.images[image].name + "." + mark.name;
            if (!marks_.emplace(name, MarkReference{image, k}).second)
                throw_input_error(mark.position, fmt::format("\"{}\" names two marks", name),
                                  "give every mark of an image a name of its own");
            all_marks_.push_back({image, k});
        }
}

MarkReference FigureNames::mark(const std::string& name, const SourcePosition& position) const {
    const auto found = marks_.find(name);
    if (found == marks_.end())
        throw_input_error(position, fmt::format("there is no mark \"{}\"", name),
                          marks_.empty() ? "give an image an [[image.mark]]"
                                         : suggestion(name, names_of(marks_)));
    return found->second;
}

std::vector<MarkReference> FigureNames::marks(const TableReader& reader,
                                              const std::string& key) const {
    const toml::node* const node = reader.find(key);
    if (node == nullptr) {
        if (all_marks_.empty())
            reader.fail(key, "the figure has no mark", "give an image an [[image.mark]]");
        return all_marks_;
    }
    std::vector<MarkReference> found;
    for (const toml::node& one :
         array_at(*node, reader.position_of_key(key), "write marks = [\"IMAGE.MARK\", ...]")) {
        const SourcePosition position = position_of(reader.file(), one);
        found.push_back(mark(text_at(one, position, "a mark"), position));
    }
    return found;
}

std::optional<MarkReference> FigureNames::mark_or_none(const TableReader& reader,
                                                       const std::string& key) const {
    if (!reader.has(key))
        return std::nullopt;
    return mark(reader.text(key), reader.position_of_key(key));
}

PanelReference FigureNames::panel(const toml::node& node, const SourcePosition& position) const {
    const std::string name = text_at(node, position, "a panel");
    const auto found = panels_.find(name);
    if (found == panels_.end())
        throw_input_error(position, fmt::format("there is no panel \"{}\"", name),
                          suggestion(name, names_of(panels_)));
    return found->second;
}

std::vector<std::vector<PanelReference>> FigureNames::rows(const TableReader& head,
                                                           const FigureRequest& request) const {
    using Kind = PanelReference::Kind;
    constexpr const char* form = "write rows = [[\"PANEL\", ...], ...]";
    std::vector<std::vector<PanelReference>> rows;
    if (const toml::node* const node = head.find("rows")) {
        for (const toml::node& row : array_at(*node, head.position_of_key("rows"), form)) {
            rows.emplace_back();
            for (const toml::node& one : array_at(row, position_of(head.file(), row), form))
                rows.back().push_back(panel(one, position_of(head.file(), one)));
        }
        return rows;
    }
    rows.resize(2);
    for (std::size_t k = 0; k < request.images.size(); ++k)
        rows[0].push_back({Kind::Image, k});
    for (std::size_t k = 0; k < request.plots.size(); ++k)
        rows[1].push_back({Kind::Plot, k});
    for (std::size_t k = 0; k < request.swatches.size(); ++k)
        rows[1].push_back({Kind::Swatches, k});
    return rows;
}

ImageRegion region_at(const TableReader& reader, const std::string& key, std::size_t count) {
    const SourcePosition position = reader.position_of_key(key);
    const std::vector<double> numbers = numbers_at(reader.required(key), reader.file(), position,
                                                   key, count, NumberRange::within(0, 65535));
    for (const double number : numbers)
        if (number != std::floor(number))
            reader.fail(key, "pixels are counted by whole numbers", "write integers");
    ImageRegion region;
    region.x0 = static_cast<int>(numbers[0]);
    region.y0 = static_cast<int>(numbers[1]);
    region.x1 = static_cast<int>(numbers[count - 2]);
    region.y1 = static_cast<int>(numbers[count - 1]);
    if (region.x1 < region.x0 || region.y1 < region.y0)
        reader.fail(key, "the second corner lies above or left of the first",
                    "write the upper left corner first");
    return region;
}

void widen(ImageRegion& region, int pixels) {
    region.x0 -= pixels;
    region.y0 -= pixels;
    region.x1 += pixels;
    region.y1 += pixels;
}

} // namespace reradiant
