#include "host/scene/document/toml_document.h"

#include "host/base/plain_text.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

constexpr int MAX_DOTTED_KEY_PARTS = 64;

/// toml++ 3.3 limits the nesting of values to 256 but not that of dotted keys: it would recurse
/// once a part when the tables are destroyed. So the dots of each key-like run are counted first.
void refuse_deep_keys(const std::string& file, std::string_view text) {
    int line = 1, column = 0, dots = 0;
    char quote = 0;
    bool comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        ++column;
        if (c == '\n') {
            ++line;
            column = 0;
            dots = 0;
            quote = 0;
            comment = false;
        } else if (comment) {
            continue;
        } else if (quote != 0) {
            if (c == '\\' && quote == '"' && i + 1 < text.size() && text[i + 1] != '\n') {
                ++i;
                ++column;
            } else if (c == quote) {
                quote = 0;
            }
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#') {
            comment = true;
        } else if (c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '=') {
            dots = 0;
        } else if (c == '.' && ++dots >= MAX_DOTTED_KEY_PARTS) {
            throw_input_error(
                {file, line, column},
                fmt::format("a dotted key of more than {} parts", MAX_DOTTED_KEY_PARTS),
                "nest tables less deeply");
        }
    }
}

} // namespace

SourcePosition position_of(const std::string& file, const toml::source_region& region) {
    return {region.path ? *region.path : file, static_cast<int>(region.begin.line),
            static_cast<int>(region.begin.column)};
}

SourcePosition position_of(const std::string& file, const toml::node& node,
                           const SourcePosition& otherwise) {
    if (node.source().begin.line > 0)
        return position_of(file, node.source());
    SourcePosition first = otherwise.line > 0 ? otherwise : SourcePosition{file};
    const auto take = [&first](const SourcePosition& found) {
        if (found.line > 0 && (first.line <= 0 || found.line < first.line ||
                               (found.line == first.line && found.column < first.column)))
            first = found;
    };
    if (const toml::table* table = node.as_table(); table != nullptr && otherwise.line <= 0)
        for (const auto& [key, value] : *table)
            take(key.source().begin.line > 0 ? position_of(file, key.source())
                                             : position_of(file, value));
    return first;
}

toml::key placed_key(const std::string& key, const SourcePosition& position) {
    const toml::source_position at{static_cast<toml::source_index>(position.line),
                                   static_cast<toml::source_index>(position.column)};
    return toml::key(key, toml::source_region{at, at, {}});
}

void place_keys(toml::table& table, const SourcePosition& position) {
    toml::table placed;
    for (auto&& [key, node] : table) {
        if (toml::table* inner = node.as_table())
            place_keys(*inner, position);
        else if (toml::array* array = node.as_array())
            for (toml::node& element : *array)
                if (toml::table* one = element.as_table())
                    place_keys(*one, position);
        const bool is_placed = key.source().begin.line > 0;
        const toml::key made = is_placed ? key : placed_key(std::string(key.str()), position);
        node.visit([&](auto& value) { placed.insert(made, std::move(value)); });
    }
    table = std::move(placed);
}

namespace {

void lay_over_array(const toml::array& above, toml::array& below) {
    for (std::size_t i = 0; i < above.size(); ++i) {
        toml::table* const under = i < below.size() ? below[i].as_table() : nullptr;
        if (under != nullptr && above[i].is_table())
            lay_over(*above[i].as_table(), *under);
        else
            below.push_back(above[i]);
    }
}

} // namespace

void lay_over(const toml::table& above, toml::table& below) {
    for (const auto& [key, node] : above) {
        toml::node* const under = below.get(key.str());
        if (under != nullptr && under->is_table() && node.is_table())
            lay_over(*node.as_table(), *under->as_table());
        else if (under != nullptr && under->is_array_of_tables() && node.is_array_of_tables())
            lay_over_array(*node.as_array(), *under->as_array());
        else {
            below.erase(key.str());
            below.insert(key, node); // the key brings its place along
        }
    }
}

toml::table parse_toml(const std::string& file, std::string_view bytes) {
    const std::string text = plain_text(bytes);
    refuse_deep_keys(file, text);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw_input_error(position_of(file, error.source()),
                          fmt::format("not valid TOML: {}", error.description()),
                          "see https://toml.io/en/v1.0.0 for the syntax");
    }
}

const char* toml_type_name(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "a string";
    case toml::node_type::integer:
        return "an integer";
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "a boolean";
    default:
        return "a date or time";
    }
}

} // namespace reradiant
