#include "tools/commands/print_tree.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <string>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
    if (value.is_number_float()) // 0.87 rather than 0.8700000000000001
        return fmt::format("{:.9g}", value.get<double>());
    return value.is_string() ? value.get<std::string>() : value.dump();
}

void print(const Json& value, const std::string& margin) {
    for (const auto& [key, entry] : value.items()) {
        const std::string name = value.is_array() ? "-" : key + ":";
        if (entry == "")
            continue;
        if (!entry.is_structured())
            fmt::print("{}{} {}\n", margin, name, text_of(entry));
        else if (!entry.empty()) {
            fmt::print("{}{}\n", margin, name);
            print(entry, margin + "  ");
        }
    }
}

} // namespace

void print_tree(const nlohmann::ordered_json& tree) {
    print(tree, "");
}

} // namespace reradiant
