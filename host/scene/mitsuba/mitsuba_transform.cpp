#include "host/scene/mitsuba/mitsuba_object.h"

#include <Eigen/Geometry>
#include <fmt/core.h>

#include <numbers>

namespace reradiant {

namespace {

/// Reads x, y, z, each `otherwise` when absent; `value` stands for all three, or holds them.
Eigen::Vector3d components(const MitsubaDocument& document, const pugi::xml_node& step,
                           double otherwise) {
    if (document.has(step, "value")) {
        const auto given = document.numbers(step, "value", 0);
        if (given.size() == 1)
            return Eigen::Vector3d::Constant(given[0]);
        if (given.size() != 3)
            document.fail(step, fmt::format("value has {} numbers", given.size()), "give 1 or 3");
        return {given[0], given[1], given[2]};
    }
    const auto part = [&](const char* axis) {
        return document.has(step, axis) ? document.number(step, axis) : otherwise;
    };
    return {part("x"), part("y"), part("z")};
}

Eigen::Vector3d triple(const MitsubaDocument& document, const pugi::xml_node& step,
                       const char* attribute) {
    const auto given = document.numbers(step, attribute, 3);
    return {given[0], given[1], given[2]};
}

Eigen::Matrix4d rotation(const MitsubaDocument& document, const pugi::xml_node& step) {
    const Eigen::Vector3d axis = components(document, step, 0.0);
    if (!(axis.norm() > 0.0))
        document.fail(step, "the axis of the rotation is zero", "give x, y or z");
    const double angle = document.number(step, "angle") * std::numbers::pi / 180.0;
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    return matrix;
}

/// Returns the matrix with the columns left, up, forward and origin, as Mitsuba's cameras have
/// them.
Eigen::Matrix4d look_at(const MitsubaDocument& document, const pugi::xml_node& step) {
    const Eigen::Vector3d origin = triple(document, step, "origin");
    const Eigen::Vector3d forward = triple(document, step, "target") - origin;
    const Eigen::Vector3d left = triple(document, step, "up").cross(forward);
    if (!(forward.norm() > 0.0) || !(left.norm() > 0.0))
        document.fail(step, "origin, target and up give no direction",
                      "target must differ from origin, and up from the view");
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.block<3, 1>(0, 0) = left.normalized();
    matrix.block<3, 1>(0, 1) = forward.cross(left).normalized();
    matrix.block<3, 1>(0, 2) = forward.normalized();
    matrix.block<3, 1>(0, 3) = origin;
    return matrix;
}

Eigen::Matrix4d given_matrix(const MitsubaDocument& document, const pugi::xml_node& step) {
    const auto values = document.numbers(step, "value", 0);
    const Eigen::Index size = values.size() == 16 ? 4 : 3;
    if (std::ssize(values) != size * size)
        document.fail(step, fmt::format("the matrix has {} numbers", values.size()),
                      "give 16 or 9");
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner(size, size) =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), size, size);
    if (!matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)))
        document.fail(step, "the matrix is a projection", "its last row must be 0 0 0 1");
    return matrix;
}

} // namespace

Eigen::Matrix4d mitsuba_transform(const MitsubaDocument& document, const pugi::xml_node& element) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (const pugi::xml_node& step : element.children()) {
        if (step.type() != pugi::node_element)
            continue;
        const std::string tag = step.name();
        Eigen::Matrix4d one = Eigen::Matrix4d::Identity();
        if (tag == "translate")
            one.block<3, 1>(0, 3) = components(document, step, 0.0);
        else if (tag == "scale")
            one.diagonal().head<3>() = components(document, step, 1.0);
        else if (tag == "rotate")
            one = rotation(document, step);
        else if (tag == "lookat" || tag == "look_at")
            one = look_at(document, step);
        else if (tag == "matrix")
            one = given_matrix(document, step);
        else
            document.fail(step, fmt::format("<{}> is not a step of a transform", tag),
                          "use translate, scale, rotate, lookat or matrix");
        matrix = one * matrix;
    }
    return matrix;
}

} // namespace reradiant
