#include "host/scene/document/key_reference.h"

#include <algorithm>
#include <regex>

namespace reradiant {

namespace {

thread_local KeyReference* living = nullptr;

std::string without_numbers(const std::string& name) {
    static const std::regex number(" [0-9]+");
    return std::regex_replace(name, number, "");
}

} // namespace

KeyReference::KeyReference() : outer_(living) {
    living = this;
}

KeyReference::~KeyReference() {
    living = outer_;
}

KeyReference* KeyReference::current() {
    return living;
}

void KeyReference::add_table(const std::string& name, const std::vector<std::string>& keys) {
    const std::string plain = without_numbers(name);
    const auto same = [&](const Table& table) { return table.name == plain; };
    const auto known = std::find_if(tables_.begin(), tables_.end(), same);
    if (known == tables_.end()) {
        tables_.push_back({plain, keys, {}});
        return;
    }
    for (const std::string& key : keys) // one name, read twice with different keys
        if (std::find(known->keys.begin(), known->keys.end(), key) == known->keys.end())
            known->keys.push_back(key);
}

void KeyReference::add_key(const std::string& table, const std::string& key, const Key& about) {
    const std::string plain = without_numbers(table);
    for (Table& known : tables_) {
        if (known.name != plain)
            continue;
        Key& entry = known.about[key];
        if (about.kind.size() > entry.kind.size())
            entry.kind = about.kind;
        if (!about.otherwise.empty())
            entry.otherwise = about.otherwise;
    }
}

void KeyReference::add_types(const std::vector<std::string>& types) {
    types_.insert(types.begin(), types.end());
}

std::vector<std::string> KeyReference::missing_types() const {
    std::vector<std::string> missing;
    for (const std::string& type : types_)
        if (std::none_of(tables_.begin(), tables_.end(), [&](const Table& table) {
                return table.name.ends_with("(" + type + ")");
            }))
            missing.push_back(type);
    return missing;
}

} // namespace reradiant
