#pragma once

#include "host/scene/document/toml_document.h"
#include "reradiant/scene.h"

#include <limits>
#include <string>
#include <vector>

namespace reradiant {

/// Numbers that a key accepts. Every number must be finite whatever the range.
struct NumberRange {
    double low = -std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::max();
    bool low_is_allowed = true;
    bool high_is_allowed = true;

    static NumberRange at_least(double low) { return {.low = low}; }
    static NumberRange above(double low) { return {.low = low, .low_is_allowed = false}; }
    static NumberRange within(double low, double high) { return {.low = low, .high = high}; }
    static NumberRange between(double low, double high) {
        return {.low = low, .high = high, .low_is_allowed = false, .high_is_allowed = false};
    }

    bool holds(double value) const;
    std::string text() const; ///< "at least 0 and below 180"
};

/// Coordinates and lengths: Embree drops primitives beyond 1.8e18 without a word.
inline constexpr double MAX_COORDINATE = 1e18;

/// Returns a finite number in range at a node; `name` and `position` are for the message.
double number_at(const toml::node& node, const SourcePosition& position, const std::string& name,
                 const NumberRange& range);
/// Returns an array of `count` numbers (any count when 0); element errors are placed at the
/// element.
std::vector<double> numbers_at(const toml::node& node, const std::string& file,
                               const SourcePosition& position, const std::string& name,
                               std::size_t count, const NumberRange& range);

/// One TOML table with the keys that it may hold. Unknown keys are refused at once, so that a
/// misspelt key is named before the one that is missing for it. Errors about a value are placed
/// at its key, errors about one element of an array at the element.
class TableReader {
public:
    /// `name` is what messages call the table, for example "[camera]".
    /// `path` is what the reference of the format calls it, the name unless something else is said.
    TableReader(const toml::table& table, std::string file, std::string name,
                std::vector<std::string> known_keys, const std::string& path = {});

    bool has(const std::string& key) const { return find(key) != nullptr; }
    const std::string& file() const { return file_; }
    const std::string& name() const { return name_; }
    SourcePosition position() const { return position_of(file_, *table_); }
    /// Returns the place of the key, or of the table when the key is absent.
    SourcePosition position_of_key(const std::string& key) const;
    [[noreturn]] void fail(const std::string& key, const std::string& what_is_wrong,
                           const std::string& remedy = {}) const;

    /// Tells a living KeyReference what a key takes, and its default.
    void describe(const std::string& key, const std::string& kind,
                  const std::string& otherwise = {}) const;

    /// Returns the node of a key; fails at the table when it is missing.
    const toml::node& required(const std::string& key) const;
    const toml::node* find(const std::string& key) const;

    double number(const std::string& key, const NumberRange& range = {}) const;
    double number_or(const std::string& key, double otherwise, const NumberRange& range = {}) const;
    int integer(const std::string& key, int low, int high) const;
    int integer_or(const std::string& key, int otherwise, int low, int high) const;
    std::string text(const std::string& key) const;
    std::string text_or(const std::string& key, const std::string& otherwise) const;
    bool flag_or(const std::string& key, bool otherwise) const;
    /// Returns one of the names given, which the message lists.
    std::string choice(const std::string& key, const std::vector<std::string>& names) const;
    /// Three numbers, each at most MAX_COORDINATE in size.
    Vector3 vector(const std::string& key) const;
    Vector3 vector_or(const std::string& key, const Vector3& otherwise) const;
    TableReader table(const std::string& key, std::vector<std::string> known_keys) const;
    const toml::table& plain_table(const std::string& key) const;
    /// The tables of an array of tables; empty when the key is absent.
    std::vector<const toml::table*> tables(const std::string& key) const;

private:
    const toml::table* table_;
    std::string file_, name_;
    std::string path_; ///< name in the reference; filled only while a KeyReference lives
    std::vector<std::string> known_keys_;
};

/// The type key of a table whose other keys depend on it.
std::string type_of_table(const toml::table& table, const std::string& file,
                          const std::string& name, const std::vector<std::string>& types);

/// Returns "did you mean "x"?", or the list when nothing is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& known);

} // namespace reradiant
