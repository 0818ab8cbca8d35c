#include "host/study/study/sweep_reader.h"

#include "host/study/study/sweep_apply.h"
#include "host/study/study/sweep_target.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_label = 40;

std::string one_line(const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_table<decltype(value)>)
            text << toml::toml_formatter(value, toml::format_flags::none);
        else
            text << value;
    });
    std::string line = text.str();
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line.size() > longest_label ? line.substr(0, longest_label) + "..." : line;
}

/// Returns what a value is called on pages and in tables.
std::string label_of(const toml::node& node) {
    if (const auto text = node.value<std::string>(); text && node.is_string())
        return fs::path(*text).stem().string() == *text ? *text
                                                        : fs::path(*text).filename().string();
    if (const auto number = node.value<double>())
        return fmt::format("{:g}", *number);
    if (const toml::table* const table = node.as_table()) {
        for (const char* key : {"illuminant", "file"})
            if (const auto name = (*table)[key].value<std::string>())
                return fs::path(*name).filename().string();
        if (const auto line = (*table)["line_nm"].value<double>())
            return fmt::format("{:g} nm", *line);
        if (const auto kelvin = (*table)["blackbody_kelvin"].value<double>())
            return fmt::format("{:g} K", *kelvin);
    }
    return one_line(node);
}

/// Files that the study names start at its folder, not at the scene's.
void make_files_absolute(toml::node& node, const fs::path& folder) {
    if (toml::array* const array = node.as_array())
        for (toml::node& element : *array)
            make_files_absolute(element, folder);
    toml::table* const table = node.as_table();
    if (table == nullptr)
        return;
    for (auto&& [key, value] : *table) {
        std::error_code ignored;
        if (toml::value<std::string>* const name = value.as_string();
            name != nullptr && key.str() == "file" && fs::exists(folder / **name, ignored))
            *name = fs::absolute(folder / **name).string();
        else
            make_files_absolute(value, folder);
    }
}

void add_value(Sweep& sweep, const toml::node& node, const std::string& name, const Study& study) {
    const fs::path folder = study.file.parent_path();
    SweepValue value;
    value.position = position_of(study.file.string(), node.source());
    value.label = name.empty() ? label_of(node) : name;
    value.shown = value.label;
    if (name.empty() && node.is_number() && !sweep.unit.empty())
        value.shown += value.label == "1" && sweep.unit == "units" ? " unit" : " " + sweep.unit;
    value.boxed.push_back(node);
    std::error_code ignored;
    if (sweep.kind == SweepKind::Matrix && node.is_string()) {
        const fs::path file = folder / *node.value<std::string>();
        if (fs::exists(file, ignored))
            *value.boxed[0].as_string() = fs::absolute(file).string();
    }
    make_files_absolute(value.boxed, folder);
    for (const SweepValue& other : sweep.values)
        if (one_line(other.node()) == one_line(value.node()) || other.label == value.label)
            throw_input_error(value.position,
                              fmt::format("the sweep has the value {} twice", value.label),
                              "leave one out, or tell them apart by names = [...]");
    sweep.values.push_back(std::move(value));
}

/// Refuses a sweep of what [measure] fixes as well.
void refuse_given_twice(const Study& study, const Sweep& sweep) {
    if (!study.measuring)
        return;
    const std::pair<SweepKind, bool> given[] = {
        {SweepKind::Angle, study.measuring->theta_i_given},
        {SweepKind::Illuminant, study.measuring->illuminants_given}};
    for (const auto& [kind, is_given] : given)
        if (sweep.kind == kind && is_given)
            throw_input_error(sweep.position,
                              fmt::format("{} is swept, and fixed by [measure]", sweep.label),
                              "leave one out");
}

/// A value may be wrong for itself: then its cells fail. When none is right the sweep is.
void check_usable(const Study& study, const Sweep& sweep) {
    std::optional<Error> first;
    for (const SweepValue& value : sweep.values) {
        try {
            scene_with(study, {{&sweep, &value}});
            return;
        } catch (const Error& error) {
            if (!first)
                first = error;
        }
    }
    throw_input_error(
        sweep.values.front().position,
        fmt::format("no value of the sweep {} can be used: {}", sweep.label, first->what()));
}

} // namespace

std::vector<std::string> texts_at(const TableReader& reader, const char* key) {
    const toml::array* const array = reader.required(key).as_array();
    if (array == nullptr || array->empty())
        reader.fail(key, fmt::format("{} is no list of names", key), "write [\"...\", ...]");
    std::vector<std::string> texts;
    for (const toml::node& element : *array) {
        if (!element.is_string())
            throw_input_error(position_of(reader.file(), element.source()),
                              fmt::format("an element of {} is {}", key, toml_type_name(element)),
                              "write a string");
        texts.push_back(*element.value<std::string>());
    }
    return texts;
}

Sweep read_sweep(const toml::table& table, const std::string& file, const Study& study) {
    const TableReader reader(table, file, "[[sweep]]", sweep_keys);
    Sweep sweep;
    resolve_target(reader, study, sweep);
    const toml::array* const values = reader.required("values").as_array();
    if (values == nullptr || values->empty())
        reader.fail("values", values == nullptr ? "values is no list" : "the sweep is empty",
                    "give the values that the parameter takes: values = [1, 2]");
    const std::vector<std::string> names =
        reader.has("names") ? texts_at(reader, "names") : std::vector<std::string>(values->size());
    if (names.size() != values->size())
        reader.fail("names", fmt::format("{} names for {} values", names.size(), values->size()),
                    "give as many names as values");
    for (std::size_t i = 0; i < values->size(); ++i)
        add_value(sweep, (*values)[i], names[i], study);
    return sweep;
}

void check_sweeps(const Study& study) {
    if (study.sweeps.empty())
        throw_input_error({study.file.string(), 1, 1}, "the study sweeps nothing",
                          "add a [[sweep]] with parameter and values");
    for (std::size_t k = 0; k < study.sweeps.size(); ++k) {
        const Sweep& sweep = study.sweeps[k];
        for (std::size_t j = 0; j < k; ++j)
            if (targets_collide(study.sweeps[j], sweep))
                throw_input_error(
                    sweep.position,
                    fmt::format("two sweeps contradict each other: {} and {} change the same thing",
                                study.sweeps[j].label, sweep.label),
                    "leave one out");
        refuse_given_twice(study, sweep);
        check_usable(study, sweep);
    }
    if (study.cell_count() > most_study_cells)
        throw_input_error(
            study.sweeps.front().position,
            fmt::format("the sweeps have more than {} combinations", most_study_cells),
            "sweep less at once");
}

} // namespace reradiant
