#pragma once

#include "host/scene/mitsuba/mitsuba_document.h"

#include <Eigen/Core>
#include <toml++/toml.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace reradiant {

/// A `MitsubaObject` is one plugin of a scene (a shape, a bsdf, ...): its properties by name and
/// its nested plugins. `finish` throws an input Error at the place of each of them that nobody has
/// asked for, so that nothing of a scene is left out in silence.
class MitsubaObject {
public:
    MitsubaObject(const MitsubaDocument& document, const pugi::xml_node& element);

    const MitsubaDocument& document() const { return *document_; }
    const pugi::xml_node& element() const { return element_; }
    const std::string& type() const { return type_; }
    std::string title() const; ///< bsdf "plastic"
    [[noreturn]] void fail(const std::string& what_is_wrong, const std::string& remedy = {}) const {
        document_->fail(element_, what_is_wrong, remedy);
    }
    /// Throws the input Error for a type that the import does not know; `known` are those that it
    /// does.
    [[noreturn]] void refuse_type(const std::vector<std::string>& known) const;

    /// Returns a property by its name, whatever its tag; empty when absent. It counts as asked for.
    pugi::xml_node find(const std::string& name) const;
    bool has(const std::string& name) const { return static_cast<bool>(find(name)); }

    /// Returns the key for something made of a property. Its place is that of the property, or of
    /// the plugin when that is absent.
    toml::key key(const char* made, const std::string& property) const;

    std::string text_or(const std::string& name, const std::string& otherwise) const;
    bool flag_or(const std::string& name, bool otherwise) const;
    double number_or(const std::string& name, double otherwise) const;
    int integer_or(const std::string& name, int otherwise) const;
    std::optional<Eigen::Vector3d> point(const std::string& name) const;
    /// The product of a <transform>'s steps; identity when there is none.
    Eigen::Matrix4d transform_or_identity(const std::string& name) const;

    /// Nested plugins of one tag in their order, references by <ref> resolved.
    std::vector<pugi::xml_node> nested(const std::string& tag) const;
    /// Leaves out a property that this program has nothing for and that changes nothing or little,
    /// with a warning.
    void ignore(const std::string& name, const std::string& why) const;
    void finish() const;

private:
    pugi::xml_node property(const std::string& name, const char* tag) const;

    const MitsubaDocument* document_;
    pugi::xml_node element_;
    std::string type_;
    mutable std::set<std::ptrdiff_t> asked_for_; ///< by the offset of the element
};

/// The matrix of a <transform>.
Eigen::Matrix4d mitsuba_transform(const MitsubaDocument& document, const pugi::xml_node& element);

} // namespace reradiant
