#include "host/scene/document/table_reader.h"

#include "host/scene/document/key_reference.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace {

/// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({above + 1, row[j - 1] + 1,
                               diagonal + (a[i - 1] == b[j - 1] ? std::size_t{0} : 1)});
            diagonal = above;
        }
    }
    return row[b.size()];
}

} // namespace

bool NumberRange::holds(double value) const {
    return std::isfinite(value) && (low_is_allowed ? value >= low : value > low) &&
           (high_is_allowed ? value <= high : value < high);
}

std::string NumberRange::text() const {
    std::string parts;
    if (low > -std::numeric_limits<double>::max())
        parts = fmt::format("{} {}", low_is_allowed ? "at least" : "above", low);
    if (high < std::numeric_limits<double>::max())
        parts += fmt::format("{}{} {}", parts.empty() ? "" : " and ",
                             high_is_allowed ? "at most" : "below", high);
    return parts.empty() ? "finite" : parts;
}

std::string suggestion(const std::string& given, const std::vector<std::string>& known) {
    const std::string limited = given.substr(0, 64);
    const std::string* nearest = nullptr;
    std::size_t smallest = std::max<std::size_t>(2, limited.size() / 3) + 1;
    for (const auto& candidate : known) {
        const std::size_t distance = edit_distance(limited, candidate);
        if (distance < smallest) {
            smallest = distance;
            nearest = &candidate;
        }
    }
    if (nearest != nullptr)
        return fmt::format("did you mean \"{}\"?", *nearest);
    return fmt::format("use one of: {}", fmt::join(known, ", "));
}

double number_at(const toml::node& node, const SourcePosition& position, const std::string& name,
                 const NumberRange& range) {
    if (!node.is_number())
        throw_input_error(position, fmt::format("{} is {}", name, toml_type_name(node)),
                          "write a number");
    const double value = *node.value<double>();
    if (!range.holds(value))
        throw_input_error(position, fmt::format("{} is {}", name, value),
                          fmt::format("it must be {}", range.text()));
    return value;
}

std::vector<double> numbers_at(const toml::node& node, const std::string& file,
                               const SourcePosition& position, const std::string& name,
                               std::size_t count, const NumberRange& range) {
    const toml::array* array = node.as_array();
    if (array == nullptr)
        throw_input_error(position, fmt::format("{} is {}", name, toml_type_name(node)),
                          "write an array of numbers");
    if (count != 0 && array->size() != count)
        throw_input_error(position, fmt::format("{} has {} numbers", name, array->size()),
                          fmt::format("give {}", count));
    std::vector<double> values;
    values.reserve(array->size());
    for (std::size_t i = 0; i < array->size(); ++i) {
        const toml::node& element = (*array)[i];
        values.push_back(number_at(element, position_of(file, element, position),
                                   fmt::format("{}[{}]", name, i), range));
    }
    return values;
}

TableReader::TableReader(const toml::table& table, std::string file, std::string name,
                         std::vector<std::string> known_keys, const std::string& path)
    : table_(&table), file_(std::move(file)), name_(std::move(name)),
      known_keys_(std::move(known_keys)) {
    if (KeyReference* const reference = KeyReference::current()) {
        path_ = path.empty() ? name_ : path;
        if (const auto type = table["type"].value<std::string>(); type && !path_.ends_with(')'))
            path_ += fmt::format(" ({})", *type);
        reference->add_table(path_, known_keys_);
    }
    const toml::key* unknown = nullptr; // the first in the file: the table is sorted by name
    const auto starts_before = [](const toml::key& a, const toml::key& b) {
        return std::pair(a.source().begin.line, a.source().begin.column) <
               std::pair(b.source().begin.line, b.source().begin.column);
    };
    for (const auto& [key, node] : table) {
        const bool known =
            std::find(known_keys_.begin(), known_keys_.end(), key.str()) != known_keys_.end();
        if (!known && (unknown == nullptr || starts_before(key, *unknown)))
            unknown = &key;
    }
    if (unknown != nullptr)
        throw_input_error(position_of(file_, unknown->source()),
                          fmt::format("unknown key \"{}\" in {}", unknown->str(), name_),
                          suggestion(std::string(unknown->str()), known_keys_));
}

void TableReader::describe(const std::string& key, const std::string& kind,
                           const std::string& otherwise) const {
    if (KeyReference* const reference = KeyReference::current())
        reference->add_key(path_, key, {kind, otherwise});
}

const toml::node* TableReader::find(const std::string& key) const {
    if (std::find(known_keys_.begin(), known_keys_.end(), key) == known_keys_.end())
        throw std::logic_error("key \"" + key + "\" was not declared for " + name_);
    return table_->get(key);
}

const toml::node& TableReader::required(const std::string& key) const {
    const toml::node* node = find(key);
    if (node == nullptr)
        throw_input_error(position(), fmt::format("{} has no \"{}\"", name_, key),
                          fmt::format("add {} = ...", key));
    return *node;
}

SourcePosition TableReader::position_of_key(const std::string& key) const {
    const auto entry = table_->find(key);
    return entry == table_->end() ? position() : position_of(file_, entry->first.source());
}

void TableReader::fail(const std::string& key, const std::string& what_is_wrong,
                       const std::string& remedy) const {
    throw_input_error(position_of_key(key), what_is_wrong, remedy);
}

double TableReader::number(const std::string& key, const NumberRange& range) const {
    describe(key, fmt::format("number, {}", range.text()));
    return number_at(required(key), position_of_key(key), key, range);
}

double TableReader::number_or(const std::string& key, double otherwise,
                              const NumberRange& range) const {
    describe(key, fmt::format("number, {}", range.text()), fmt::format("{}", otherwise));
    return has(key) ? number(key, range) : otherwise;
}

int TableReader::integer(const std::string& key, int low, int high) const {
    describe(key, fmt::format("whole number, {} to {}", low, high));
    const toml::node& node = required(key);
    if (!node.is_integer())
        fail(key, fmt::format("{} is {}", key, toml_type_name(node)), "write a whole number");
    const std::int64_t value = *node.value<std::int64_t>();
    if (value < low || value > high)
        fail(key, fmt::format("{} is {}", key, value),
             fmt::format("it must be from {} to {}", low, high));
    return static_cast<int>(value);
}

int TableReader::integer_or(const std::string& key, int otherwise, int low, int high) const {
    describe(key, fmt::format("whole number, {} to {}", low, high), fmt::format("{}", otherwise));
    return has(key) ? integer(key, low, high) : otherwise;
}

std::string TableReader::text(const std::string& key) const {
    describe(key, "string");
    const toml::node& node = required(key);
    if (!node.is_string())
        fail(key, fmt::format("{} is {}", key, toml_type_name(node)), "write a string");
    return *node.value<std::string>();
}

std::string TableReader::text_or(const std::string& key, const std::string& otherwise) const {
    describe(key, "string", otherwise);
    return has(key) ? text(key) : otherwise;
}

bool TableReader::flag_or(const std::string& key, bool otherwise) const {
    describe(key, "true or false", otherwise ? "true" : "false");
    if (!has(key))
        return otherwise;
    const toml::node& node = required(key);
    if (!node.is_boolean())
        fail(key, fmt::format("{} is {}", key, toml_type_name(node)), "write true or false");
    return *node.value<bool>();
}

std::string TableReader::choice(const std::string& key,
                                const std::vector<std::string>& names) const {
    describe(key, fmt::format("one of {}", fmt::join(names, ", ")));
    const std::string given = text(key);
    if (std::find(names.begin(), names.end(), given) == names.end())
        fail(key, fmt::format("{} is \"{}\"", key, given),
             fmt::format("use one of: {}", fmt::join(names, ", ")));
    return given;
}

Vector3 TableReader::vector(const std::string& key) const {
    describe(key, "array of 3 numbers");
    const auto values = numbers_at(required(key), file_, position_of_key(key), key, 3,
                                   NumberRange::within(-MAX_COORDINATE, MAX_COORDINATE));
    return {values[0], values[1], values[2]};
}

Vector3 TableReader::vector_or(const std::string& key, const Vector3& otherwise) const {
    describe(key, "array of 3 numbers", fmt::format("[{}]", fmt::join(otherwise, ", ")));
    return has(key) ? vector(key) : otherwise;
}

const toml::table& TableReader::plain_table(const std::string& key) const {
    const toml::node& node = required(key);
    const toml::table* table = node.as_table();
    if (table == nullptr)
        fail(key, fmt::format("{} is {}", key, toml_type_name(node)), "write a table");
    return *table;
}

TableReader TableReader::table(const std::string& key, std::vector<std::string> known_keys) const {
    describe(key, "table");
    return {plain_table(key), file_, fmt::format("[{}]", key), std::move(known_keys),
            path_.empty() ? std::string() : fmt::format("{}.{}", path_, key)};
}

std::vector<const toml::table*> TableReader::tables(const std::string& key) const {
    describe(key, "array of tables");
    std::vector<const toml::table*> found;
    const toml::node* node = find(key);
    if (node == nullptr)
        return found;
    const toml::array* array = node->as_array();
    if (array == nullptr)
        fail(key, fmt::format("{} is {}", key, toml_type_name(*node)),
             fmt::format("write an array of tables: [[{}]]", key));
    for (const toml::node& element : *array) {
        if (!element.is_table())
            throw_input_error(position_of(file_, element),
                              fmt::format("an element of {} is {}", key, toml_type_name(element)),
                              "write a table");
        found.push_back(element.as_table());
    }
    return found;
}

std::string type_of_table(const toml::table& table, const std::string& file,
                          const std::string& name, const std::vector<std::string>& types) {
    if (KeyReference* const reference = KeyReference::current())
        reference->add_types(types);
    const auto entry = table.find("type");
    if (entry == table.end())
        throw_input_error(position_of(file, table), fmt::format("{} has no \"type\"", name),
                          fmt::format("add type = one of: {}", fmt::join(types, ", ")));
    const SourcePosition at = position_of(file, entry->first.source());
    if (!entry->second.is_string())
        throw_input_error(at, fmt::format("type is {}", toml_type_name(entry->second)),
                          "write a string");
    const std::string type = *entry->second.value<std::string>();
    if (std::find(types.begin(), types.end(), type) == types.end())
        throw_input_error(at, fmt::format("{} has the unknown type \"{}\"", name, type),
                          suggestion(type, types));
    return type;
}

} // namespace reradiant
