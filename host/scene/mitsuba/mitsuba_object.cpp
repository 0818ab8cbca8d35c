#include "host/scene/mitsuba/mitsuba_object.h"

#include "host/base/logging.h"
#include "host/scene/document/toml_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace reradiant {

MitsubaObject::MitsubaObject(const MitsubaDocument& document, const pugi::xml_node& element)
    : document_(&document), element_(element), type_(document.text(element, "type")) {}

std::string MitsubaObject::title() const {
    return fmt::format("{} \"{}\"", element_.name(), type_);
}

void MitsubaObject::refuse_type(const std::vector<std::string>& known) const {
    fail(fmt::format("the {} is not supported", title()),
         fmt::format("supported are: {}", fmt::join(known, ", ")));
}

pugi::xml_node MitsubaObject::find(const std::string& name) const {
    for (const pugi::xml_node& child : element_.children())
        if (child.type() == pugi::node_element && name == child.attribute("name").value()) {
            asked_for_.insert(child.offset_debug());
            return child;
        }
    return {};
}

pugi::xml_node MitsubaObject::property(const std::string& name, const char* tag) const {
    const pugi::xml_node found = find(name);
    if (found && std::string(found.name()) != tag)
        document_->fail(found, fmt::format("{} of the {} is a <{}>", name, title(), found.name()),
                        fmt::format("only <{}> is supported there", tag));
    return found;
}

toml::key MitsubaObject::key(const char* made, const std::string& property) const {
    const pugi::xml_node found = find(property);
    return placed_key(made, document_->position(found ? found : element_));
}

std::string MitsubaObject::text_or(const std::string& name, const std::string& otherwise) const {
    const pugi::xml_node found = property(name, "string");
    return found ? document_->text(found, "value") : otherwise;
}

bool MitsubaObject::flag_or(const std::string& name, bool otherwise) const {
    const pugi::xml_node found = property(name, "boolean");
    if (!found)
        return otherwise;
    const std::string value = document_->text(found, "value");
    if (value != "true" && value != "false")
        document_->fail(found, fmt::format("{} is \"{}\"", name, value), "write true or false");
    return value == "true";
}

double MitsubaObject::number_or(const std::string& name, double otherwise) const {
    const pugi::xml_node found = find(name);
    if (!found)
        return otherwise;
    if (std::string(found.name()) != "integer") // a whole number is a number, too
        property(name, "float");
    return document_->number(found, "value");
}

int MitsubaObject::integer_or(const std::string& name, int otherwise) const {
    const pugi::xml_node found = property(name, "integer");
    if (!found)
        return otherwise;
    const double value = document_->number(found, "value");
    if (value != std::floor(value) || !(std::abs(value) < 2e9))
        document_->fail(found, fmt::format("{} is {}", name, value), "write a whole number");
    return static_cast<int>(value);
}

std::optional<Eigen::Vector3d> MitsubaObject::point(const std::string& name) const {
    const pugi::xml_node found = find(name);
    if (!found)
        return std::nullopt;
    if (std::string(found.name()) != "point" && std::string(found.name()) != "vector")
        document_->fail(found, fmt::format("{} is a <{}>", name, found.name()),
                        "write a <point> or a <vector>");
    if (document_->has(found, "value")) {
        const auto xyz = document_->numbers(found, "value", 3);
        return Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
    }
    const auto part = [&](const char* axis) {
        return document_->has(found, axis) ? document_->number(found, axis) : 0.0;
    };
    return Eigen::Vector3d(part("x"), part("y"), part("z"));
}

Eigen::Matrix4d MitsubaObject::transform_or_identity(const std::string& name) const {
    const pugi::xml_node found = property(name, "transform");
    return found ? mitsuba_transform(*document_, found) : Eigen::Matrix4d::Identity();
}

std::vector<pugi::xml_node> MitsubaObject::nested(const std::string& tag) const {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node& child : element_.children()) {
        if (child.type() != pugi::node_element)
            continue;
        const bool is_reference = std::string(child.name()) == "ref";
        const pugi::xml_node meant =
            is_reference ? document_->with_id(document_->text(child, "id"), child) : child;
        if (tag != meant.name())
            continue;
        asked_for_.insert(child.offset_debug());
        found.push_back(meant);
    }
    return found;
}

void MitsubaObject::ignore(const std::string& name, const std::string& why) const {
    if (const pugi::xml_node found = find(name))
        logging::warn("{}: {} of the {} is left out: {}", document_->position(found).text(), name,
                      title(), why);
}

void MitsubaObject::finish() const {
    for (const pugi::xml_node& child : element_.children()) {
        if (child.type() != pugi::node_element || std::string(child.name()) == "default" ||
            asked_for_.count(child.offset_debug()) > 0)
            continue;
        const std::string name = child.attribute("name").value();
        document_->fail(child,
                        fmt::format("<{}{}> is not supported in a {}", child.name(),
                                    name.empty() ? name : fmt::format(" name=\"{}\"", name),
                                    title()),
                        "leave it out, or change the scene to do without");
    }
}

} // namespace reradiant
