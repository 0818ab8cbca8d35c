#pragma once

#include "reradiant/error.h"

#include <Eigen/Core>
#include <pugixml.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// An XML file of Mitsuba 3 whose elements know their line and column. `$name` in attributes
/// stands for the value of a <default>.
class MitsubaDocument {
public:
    /// Input Error with the place for what is not XML, or whose root is no <scene>.
    explicit MitsubaDocument(const std::filesystem::path& file);

    const std::filesystem::path& file() const { return file_; }
    pugi::xml_node scene() const { return scene_; }
    SourcePosition position(const pugi::xml_node& element) const;
    [[noreturn]] void fail(const pugi::xml_node& element, const std::string& what_is_wrong,
                           const std::string& remedy = {}) const;
    /// The element with this id; input Error at `reference` when there is none.
    pugi::xml_node with_id(const std::string& id, const pugi::xml_node& reference) const;

    bool has(const pugi::xml_node& element, const char* attribute) const;
    /// An attribute with its `$names` replaced; input Error when it is missing.
    std::string text(const pugi::xml_node& element, const char* attribute) const;
    /// Numbers apart by blanks or commas; `count` 0: any count but none.
    std::vector<double> numbers(const pugi::xml_node& element, const char* attribute,
                                std::size_t count) const;
    double number(const pugi::xml_node& element, const char* attribute) const;

private:
    SourcePosition position_at(std::ptrdiff_t offset) const;
    /// Reads <default>s and ids of the whole tree; refuses too deep nesting.
    void index(const pugi::xml_node& element, int depth);

    std::filesystem::path file_;
    std::vector<std::ptrdiff_t> line_starts_{0};
    pugi::xml_document document_;
    pugi::xml_node scene_;
    std::map<std::string, std::string> defaults_;
    std::map<std::string, pugi::xml_node> ids_;
};

} // namespace reradiant
