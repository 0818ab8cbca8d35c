#include "host/spectral/spectrum/spectrum_formats.h"
#include "host/spectral/text/text_reader.h"

#include <fmt/core.h>
#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace reradiant {

namespace {

/// Name of an element without the prefix of its namespace.
std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const auto colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

class Tm27Reader {
public:
    explicit Tm27Reader(const std::filesystem::path& file)
        : name_(file.string()), text_(read_text_file(file)) {
        for (std::size_t i = 0; i < text_.size(); ++i)
            if (text_[i] == '\n')
                line_starts_.push_back(static_cast<std::ptrdiff_t>(i) + 1);
        const auto result = document_.load_buffer(text_.data(), text_.size(), pugi::parse_default,
                                                  pugi::encoding_utf8);
        if (!result)
            throw_input_error(position_at(result.offset),
                              fmt::format("not valid XML: {}", result.description()),
                              "give a whole .spdx file in UTF-8");
    }

    NumberTable read() const {
        const pugi::xml_node root = document_.document_element();
        const pugi::xml_node distribution = only_child(root, "SpectralDistribution");
        require_known_quantity(distribution);
        UnsortedTable table{name_, {{}, {}}, {}, UnitSource::Stated};
        for (const pugi::xml_node& point : distribution.children()) {
            if (local_name(point) != "SpectralData")
                continue;
            const SourcePosition at = position(point);
            table.columns[0].push_back(
                wavelength_nm_at(trimmed(point.attribute("wavelength").value()), at));
            table.columns[1].push_back(number_at(trimmed(text_of(point)), at));
            table.places.push_back({at.line, at.column});
        }
        if (table.places.empty())
            throw_input_error(position(distribution), "no SpectralData in it",
                              "write <SpectralData wavelength=\"400\">0.5</SpectralData>");
        return sorted_table(std::move(table));
    }

private:
    SourcePosition position_at(std::ptrdiff_t offset) const {
        const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
        const std::ptrdiff_t start = *(after - 1);
        return {name_, static_cast<int>(after - line_starts_.begin()),
                static_cast<int>(offset - start) + 1};
    }

    /// Returns the place of the '<' before the element's name.
    SourcePosition position(const pugi::xml_node& node) const {
        return position_at(std::max<std::ptrdiff_t>(1, node.offset_debug()) - 1);
    }

    /// The whole text of an element, which comments may divide.
    std::string text_of(const pugi::xml_node& element) const {
        std::string text;
        for (const pugi::xml_node& child : element.children())
            if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
                text += child.value();
            else
                throw_input_error(position(element), "more than a number in SpectralData",
                                  "write <SpectralData wavelength=\"400\">0.5</SpectralData>");
        return text;
    }

    pugi::xml_node only_child(const pugi::xml_node& parent, std::string_view name) const {
        pugi::xml_node found;
        for (const pugi::xml_node& node : parent.children()) {
            if (local_name(node) != name)
                continue;
            if (found)
                throw_input_error(position(node), fmt::format("a second {}", name),
                                  "give a file of one spectrum");
            found = node;
        }
        if (!found)
            throw_input_error(position(parent), fmt::format("no {} in this file", name),
                              "give a spectrum after IES TM-27");
        return found;
    }

    /// TM-27 names what the values are; anything but "other" is a spectrum in unit 1 or per nm.
    void require_known_quantity(const pugi::xml_node& distribution) const {
        constexpr std::array<std::string_view, 10> known{
            "flux",     "transmittance", "reflectance", "intensity", "irradiance",
            "radiance", "exitance",      "r-factor",    "t-factor",  "relative"};
        for (const pugi::xml_node& node : distribution.children()) {
            if (local_name(node) != "SpectralQuantity")
                continue;
            std::string quantity(trimmed(node.child_value()));
            std::transform(quantity.begin(), quantity.end(), quantity.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            if (std::find(known.begin(), known.end(), quantity) == known.end())
                throw_input_error(position(node),
                                  fmt::format("the SpectralQuantity '{}' is not read", quantity),
                                  "give reflectance, transmittance, or light");
        }
    }

    std::string name_, text_;
    std::vector<std::ptrdiff_t> line_starts_{0};
    pugi::xml_document document_;
};

} // namespace

NumberTable read_tm27(const std::filesystem::path& file) {
    return Tm27Reader(file).read();
}

} // namespace reradiant
