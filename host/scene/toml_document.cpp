#include "host/scene/toml_document.h"

#include "host/plain_text.h"

#include <fmt/format.h>

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
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
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
