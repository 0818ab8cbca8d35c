#pragma once

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// The [[texture]] tables of a file and of those that it includes, and where they stand while a
/// material is read. A material is read once at the middle of every texture, which finds the
/// textures that it uses, and then once per combination of their levels.
class TextureScope {
public:
    TextureScope() = default;
    /// Reads every [[texture]] of `root` into state.textures (and their images). `root` must
    /// outlive the scope: what t stands for is read where the texture is used.
    TextureScope(const TableReader& root, LoadState& state) { add(root, state); }
    /// Adds those of another file.
    void add(const TableReader& root, LoadState& state);

    /// Knows the textures of another scope, too, by those names that are not taken.
    void add_from(const TextureScope& other) {
        entries_.insert(other.entries_.begin(), other.entries_.end());
    }

    struct Entry {
        int texture = 0; ///< into LoadState::textures
        const toml::table* table = nullptr;
        std::string file;
    };
    /// The texture that `texture = "name"` means; input Error at the key when there is none.
    const Entry& entry(const TableReader& reference) const;

    /// t of a texture during this reading; a texture met for the first time joins used().
    double level_of(int texture);
    const std::vector<int>& used() const { return used_; }
    void forget_used() { used_.clear(); }
    /// t of every used texture for the readings that follow.
    void set_levels(std::vector<double> levels) { levels_ = std::move(levels); }

    bool inside_reference = false; ///< low and high of a texture cannot be textures

private:
    std::map<std::string, Entry> entries_;
    std::vector<int> used_;
    std::vector<double> levels_;
};

/// A reference `{ texture = "name", low = ..., high = ... }`: low + t (high - low), where low and
/// high come from the reference, else from the texture, else are 0 and 1.
struct TextureReference {
    struct End {
        const toml::node* node = nullptr; ///< null: 0 or 1
        std::string file;
    };
    int texture = 0;
    double t = 0.0; ///< at this reading
    End low, high;
    SourcePosition position;
};

/// True for a table with the key `texture`.
bool is_texture_reference(const toml::node& node);
/// The reference at a node, counted as a use of the texture at some level.
TextureReference read_texture_reference(const toml::node& node, const std::string& file,
                                        const std::string& name, LoadState& state);
/// The texture that a table `{ texture = "name" }` refers to with no level: for normals and
/// mixtures, which are looked up where they are used.
int read_texture_index(const TableReader& table, const std::string& key, LoadState& state);

/// A number of a material: plain or textured.
double read_number_key(const TableReader& table, const std::string& key, const NumberRange& range,
                       LoadState& state);
double read_number_key_or(const TableReader& table, const std::string& key, double otherwise,
                          const NumberRange& range, LoadState& state);

/// One [[texture]] table (`validate --reference` has its keys).
Texture read_texture(const toml::table& table, const std::string& file, std::size_t index,
                     LoadState& state);

} // namespace reradiant
