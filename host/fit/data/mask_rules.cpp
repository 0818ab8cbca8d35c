#include "reradiant/fit.h"

#include "host/spectral/text/text_reader.h"
#include "reradiant/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace reradiant {

namespace {

constexpr double longest_nm = 10000.0;

[[noreturn]] void refuse(std::string_view rule, const std::string& what) {
    throw_input_error({}, fmt::format("--mask: '{}' {}", rule, what),
                      "write none, or a list such as auto,first:10,second:15,third:15,half:15,"
                      "box:300-350x500-560 (nm; boxes are excitation x emission)");
}

/// Takes a wavelength or width off the front of the text.
std::optional<double> take_number(std::string_view& text) {
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (error != std::errc{} || !(value >= 0.0 && value <= longest_nm))
        return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix))
        return false;
    text.remove_prefix(prefix.size());
    return true;
}

MaskBox box_from(std::string_view rule, std::string_view text) {
    double numbers[4];
    constexpr std::string_view after[] = {"-", "x", "-", ""};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::optional<double> number = take_number(text);
        if (!number || !take(text, after[k]))
            refuse(rule, "is no box");
        numbers[k] = *number;
    }
    if (!text.empty())
        refuse(rule, "is no box");
    const MaskBox box{numbers[0], numbers[1], numbers[2], numbers[3]};
    if (box.excitation_from_nm > box.excitation_to_nm || box.emission_from_nm > box.emission_to_nm)
        refuse(rule, "is empty: a range ends before it begins");
    return box;
}

/// The line that a rule like `second:15` names; empty: its name is no order.
std::optional<ScatterLine> line_from(std::string_view rule) {
    for (const ScatterOrder order : scatter_orders) {
        std::string_view text = rule;
        if (!take(text, scatter_order_name(order)))
            continue;
        if (!take(text, ":"))
            refuse(rule, "has no half width in nm");
        const std::optional<double> half_width = take_number(text);
        if (!half_width || !text.empty() || *half_width == 0.0)
            refuse(rule, "has no half width above 0 nm");
        return ScatterLine{order, *half_width};
    }
    return std::nullopt;
}

void add_rule(std::string_view rule, MaskRules& rules) {
    std::string_view text = rule;
    if (text == "auto") {
        rules.automatic = true;
        return;
    }
    if (text == "none")
        refuse(rule, "stands alone or not at all");
    if (take(text, "box:")) {
        rules.boxes.push_back(box_from(rule, text));
        return;
    }
    const std::optional<ScatterLine> line = line_from(rule);
    if (!line)
        refuse(rule, "is not known");
    if (std::any_of(rules.lines.begin(), rules.lines.end(),
                    [&](const ScatterLine& other) { return other.order == line->order; }))
        refuse(rule, "names an order for the second time");
    rules.lines.push_back(*line);
}

} // namespace

MaskRules mask_rules_from_text(const std::string& text) {
    MaskRules rules;
    rules.automatic = false;
    if (text == "none")
        return rules;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        add_rule(trimmed(std::string_view(text).substr(begin, end - begin)), rules);
        begin = end + 1;
    }
    return rules;
}

std::string mask_rules_text(const MaskRules& rules) {
    std::vector<std::string> texts;
    if (rules.automatic)
        texts.push_back("auto");
    for (const ScatterLine& line : rules.lines)
        texts.push_back(fmt::format("{}:{}", scatter_order_name(line.order), line.half_width_nm));
    for (const MaskBox& box : rules.boxes)
        texts.push_back(fmt::format("box:{}-{}x{}-{}", box.excitation_from_nm, box.excitation_to_nm,
                                    box.emission_from_nm, box.emission_to_nm));
    return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ","));
}

} // namespace reradiant
