#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace reradiant {

/// Gathers, while it lives, what the readers of this thread say about the keys of their tables: the
/// reference of the file format is made of the loader's own calls and cannot be stale.
class KeyReference {
public:
    struct Key {
        std::string kind;      ///< "number, at least 0"; empty: never read while this lived
        std::string otherwise; ///< the default; empty: required, or none
    };
    struct Table {
        std::string name;
        std::vector<std::string> keys; ///< all that it may hold, in the loader's order
        std::map<std::string, Key> about;
    };

    KeyReference();
    ~KeyReference();
    KeyReference(const KeyReference&) = delete;
    KeyReference& operator=(const KeyReference&) = delete;

    /// Returns the one that lives on this thread, or null.
    static KeyReference* current();

    /// Adds a table, which is known by its name and keys; numbers ("[[light]] 3") are taken out of
    /// the name.
    void add_table(const std::string& name, const std::vector<std::string>& keys);
    /// Adds a key. If several readings describe the same one, the longest text is kept, since that
    /// has the default.
    void add_key(const std::string& table, const std::string& key, const Key& about);

    /// Adds types that a table may have; each of them needs a table of its own.
    void add_types(const std::vector<std::string>& types);

    const std::vector<Table>& tables() const { return tables_; }
    /// Returns the types for which no table "... (type)" was read while this lived.
    std::vector<std::string> missing_types() const;

private:
    KeyReference* outer_;
    std::vector<Table> tables_;
    std::set<std::string> types_;
};

} // namespace reradiant
