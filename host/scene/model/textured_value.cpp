#include "host/scene/model/textured_value.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace {

constexpr double MIDDLE = 0.5;

TextureScope& scope_of(LoadState& state, const SourcePosition& at, const std::string& name) {
    if (state.texture_scope == nullptr)
        throw_input_error(at, fmt::format("{} is a texture", name),
                          "only materials have textures; give a number or a spectrum");
    return *state.texture_scope;
}

const std::vector<std::string> REFERENCE_KEYS{"texture", "low", "high"};

TextureReference::End end_of(const toml::table& reference, const std::string& file,
                             const TextureScope::Entry& entry, const char* key) {
    if (const toml::node* node = reference.get(key))
        return {node, file};
    return {entry.table->get(key), entry.file};
}

} // namespace

void TextureScope::add(const TableReader& root, LoadState& state) {
    const auto tables = root.tables("texture");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        Texture texture = read_texture(*tables[i], root.file(), i, state);
        const Entry entry{static_cast<int>(state.textures.size()), tables[i], root.file()};
        if (!entries_.emplace(texture.name, entry).second)
            throw_input_error(position_of(root.file(), tables[i]->find("name")->first.source()),
                              fmt::format("two textures are called \"{}\"", texture.name),
                              "give each its own name");
        state.textures.push_back(std::move(texture));
    }
}

const TextureScope::Entry& TextureScope::entry(const TableReader& reference) const {
    const std::string name = reference.text("texture");
    const auto found = entries_.find(name);
    if (found != entries_.end())
        return found->second;
    std::vector<std::string> names;
    for (const auto& [known, ignored] : entries_)
        names.push_back(known);
    reference.fail("texture", fmt::format("no texture is called \"{}\"", name),
                   names.empty() ? "add a [[texture]]"
                                 : fmt::format("there are: {}", fmt::join(names, ", ")));
}

double TextureScope::level_of(int texture) {
    const auto found = std::find(used_.begin(), used_.end(), texture);
    const auto place = static_cast<std::size_t>(found - used_.begin());
    if (found == used_.end())
        used_.push_back(texture);
    return place < levels_.size() ? levels_[place] : MIDDLE;
}

bool is_texture_reference(const toml::node& node) {
    const toml::table* table = node.as_table();
    return table != nullptr && table->contains("texture");
}

TextureReference read_texture_reference(const toml::node& node, const std::string& file,
                                        const std::string& name, LoadState& state) {
    const toml::table& table = *node.as_table();
    const TableReader reader(table, file, fmt::format("the texture reference {}", name),
                             REFERENCE_KEYS, "a texture reference");
    reader.describe("texture", "string");
    reader.describe("low", "number or SPECTRUM", "that of the texture");
    reader.describe("high", "number or SPECTRUM", "that of the texture");
    TextureScope& scope = scope_of(state, reader.position_of_key("texture"), name);
    if (scope.inside_reference)
        reader.fail("texture", "low and high of a texture cannot be textures",
                    "give numbers or spectra");
    const TextureScope::Entry& entry = scope.entry(reader);
    const Texture& texture = state.textures[static_cast<std::size_t>(entry.texture)];
    if (texture.is_normal_map)
        reader.fail("texture", fmt::format("the texture \"{}\" is a normal map", texture.name),
                    "use it as normal = { texture = ... }");
    TextureReference reference;
    reference.texture = entry.texture;
    reference.t = scope.level_of(entry.texture);
    reference.low = end_of(table, file, entry, "low");
    reference.high = end_of(table, file, entry, "high");
    reference.position = reader.position_of_key("texture");
    return reference;
}

int read_texture_index(const TableReader& table, const std::string& key, LoadState& state) {
    const TableReader reader = table.table(key, {"texture"});
    return scope_of(state, reader.position_of_key("texture"), key).entry(reader).texture;
}

double read_number_key(const TableReader& table, const std::string& key, const NumberRange& range,
                       LoadState& state) {
    table.describe(key, fmt::format("number or texture, {}", range.text()));
    const toml::node& node = table.required(key);
    if (!is_texture_reference(node))
        return table.number(key, range);
    const TextureReference reference = read_texture_reference(node, table.file(), key, state);
    const auto end = [&](const TextureReference::End& at, const char* name, double otherwise) {
        return at.node == nullptr ? otherwise
                                  : number_at(*at.node, position_of(at.file, *at.node), name, {});
    };
    const double low = end(reference.low, "low", 0.0), high = end(reference.high, "high", 1.0);
    // Both ends are checked at every level, so that the first reading finds what is wrong.
    for (const double value : {low, high})
        if (!range.holds(value))
            table.fail(key, fmt::format("{} reaches {} by its texture", key, value),
                       fmt::format("it must be {}", range.text()));
    return low + reference.t * (high - low);
}

double read_number_key_or(const TableReader& table, const std::string& key, double otherwise,
                          const NumberRange& range, LoadState& state) {
    table.describe(key, fmt::format("number or texture, {}", range.text()),
                   fmt::format("{}", otherwise));
    return table.has(key) ? read_number_key(table, key, range, state) : otherwise;
}

} // namespace reradiant
