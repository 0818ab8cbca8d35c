#include "host/scene/mitsuba/mitsuba_document.h"

#include "host/base/plain_text.h"
#include "host/scene/document/load_state.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace reradiant {

namespace {

constexpr int most_nesting = 32;

bool is_separator(char c) {
    return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r';
}

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

} // namespace

MitsubaDocument::MitsubaDocument(const std::filesystem::path& file) : file_(file) {
    const std::string text = plain_text(read_file(file, {file.string()}, MAX_TOML_BYTES));
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n')
            line_starts_.push_back(static_cast<std::ptrdiff_t>(i) + 1);
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
        throw_input_error(position_at(result.offset),
                          fmt::format("not valid XML: {}", result.description()),
                          "give a scene of Mitsuba 3 in UTF-8");
    scene_ = document_.document_element();
    if (std::string(scene_.name()) != "scene")
        fail(scene_, fmt::format("the root is <{}>", scene_.name()), "a scene starts with <scene>");
    if (!scene_.attribute("version"))
        fail(scene_, "the scene has no version", "write <scene version=\"3.0.0\">");
    index(scene_, 0);
}

SourcePosition MitsubaDocument::position_at(std::ptrdiff_t offset) const {
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    const std::ptrdiff_t start = *(after - 1);
    return {file_.string(), static_cast<int>(after - line_starts_.begin()),
            static_cast<int>(offset - start) + 1};
}

SourcePosition MitsubaDocument::position(const pugi::xml_node& element) const {
    return position_at(element.offset_debug() - 1); // of the '<' before the name
}

void MitsubaDocument::fail(const pugi::xml_node& element, const std::string& what_is_wrong,
                           const std::string& remedy) const {
    throw_input_error(position(element), what_is_wrong, remedy);
}

void MitsubaDocument::index(const pugi::xml_node& element, int depth) {
    if (depth > most_nesting)
        fail(element, fmt::format("elements are nested more than {} deep", most_nesting),
             "flatten the scene");
    for (const pugi::xml_node& child : element.children()) {
        if (child.type() != pugi::node_element)
            continue;
        const std::string tag = child.name();
        if (tag == "include" || tag == "path" || tag == "alias")
            fail(child, fmt::format("<{}> is not supported", tag),
                 "write the scene into one file, with paths that start at its folder");
        if (tag == "default")
            defaults_.emplace(text(child, "name"), text(child, "value"));
        else if (tag != "ref" && child.attribute("id") &&
                 !ids_.emplace(text(child, "id"), child).second)
            fail(child, fmt::format("the id \"{}\" is used twice", text(child, "id")),
                 "give each element its own");
        index(child, depth + 1);
    }
}

pugi::xml_node MitsubaDocument::with_id(const std::string& id,
                                        const pugi::xml_node& reference) const {
    const auto found = ids_.find(id);
    if (found == ids_.end())
        fail(reference, fmt::format("no element has the id \"{}\"", id),
             "give the id of an element of this file");
    return found->second;
}

bool MitsubaDocument::has(const pugi::xml_node& element, const char* attribute) const {
    return static_cast<bool>(element.attribute(attribute));
}

std::string MitsubaDocument::text(const pugi::xml_node& element, const char* attribute) const {
    const pugi::xml_attribute found = element.attribute(attribute);
    if (!found)
        fail(element, fmt::format("<{}> has no \"{}\"", element.name(), attribute),
             fmt::format("add {}=\"...\"", attribute));
    const std::string given = found.value();
    std::string result;
    for (std::size_t i = 0; i < given.size();) {
        if (given[i] != '$') {
            result += given[i++];
            continue;
        }
        std::size_t end = i + 1;
        while (end < given.size() && is_name_character(given[end]))
            ++end;
        const std::string name = given.substr(i + 1, end - i - 1);
        const auto value = defaults_.find(name);
        if (value == defaults_.end())
            fail(element, fmt::format("${} has no value", name),
                 fmt::format("add <default name=\"{}\" value=\"...\"/> before it", name));
        result += value->second;
        i = end;
    }
    return result;
}

std::vector<double> MitsubaDocument::numbers(const pugi::xml_node& element, const char* attribute,
                                             std::size_t count) const {
    const std::string given = text(element, attribute);
    std::vector<double> values;
    for (const char *at = given.data(), *const end = at + given.size();;) {
        at = std::find_if_not(at, end, is_separator);
        if (at == end)
            break;
        double value = 0.0;
        const auto [stop, code] = std::from_chars(*at == '+' ? at + 1 : at, end, value);
        if (code != std::errc{} || (stop != end && !is_separator(*stop)) || !std::isfinite(value))
            fail(element,
                 fmt::format("{}=\"{}\" is not made of numbers", attribute, given.substr(0, 80)),
                 "write finite numbers");
        values.push_back(value);
        at = stop;
    }
    if (values.empty() || (count != 0 && values.size() != count))
        fail(element, fmt::format("{} has {} numbers", attribute, values.size()),
             count != 0 ? fmt::format("give {}", count) : std::string("give at least one"));
    return values;
}

double MitsubaDocument::number(const pugi::xml_node& element, const char* attribute) const {
    return numbers(element, attribute, 1).front();
}

} // namespace reradiant
