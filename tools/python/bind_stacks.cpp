#include "host/layers/models/effective_matrix.h"
#include "host/report/svg.h"
#include "host/scene/toml/stack_file.h"
#include "reradiant/scene_file.h"
#include "reradiant/stack_model.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace py = pybind11;

namespace reradiant::python {

namespace {

using StackPointer = std::shared_ptr<LayerStack>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double cosine_of(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180.0);
}

StackPointer load(const py::object& argument) {
    const Source source = source_from(argument);
    return std::make_shared<LayerStack>(source.table ? stack_from_table(*source.table, source.file)
                                                     : load_stack(source.file));
}

/// One quantity of the stack above the substrate, (angle, wavelength).
Rows table_of(const LayerStack& stack, const std::vector<double>& theta_deg,
              const std::vector<double>& nm,
              const std::function<double(const StackModel&, double)>& quantity, StopFlag stop) {
    Rows table(static_cast<Eigen::Index>(theta_deg.size()), static_cast<Eigen::Index>(nm.size()));
    for (Eigen::Index k = 0; k < table.cols(); ++k) {
        throw_if_stopped(stop);
        const auto transport = adding_transport(stack_at(stack, nm[static_cast<std::size_t>(k)]));
        for (Eigen::Index j = 0; j < table.rows(); ++j)
            table(j, k) = quantity(*transport, cosine_of(theta_deg[static_cast<std::size_t>(j)]));
    }
    return table;
}

Rows transmission(const LayerStack& stack, const Doubles& theta_deg, const Doubles& nm) {
    const auto angles = to_vector(theta_deg), bands = to_vector(nm);
    return interruptible([&](StopFlag stop) {
        return table_of(
            stack, angles, bands,
            [](const StackModel& t, double cosine) { return t.transmission(cosine); }, stop);
    });
}

Rows specular_albedo(const LayerStack& stack, const Doubles& theta_deg, const Doubles& nm) {
    const auto angles = to_vector(theta_deg), bands = to_vector(nm);
    return interruptible([&](StopFlag stop) {
        return table_of(
            stack, angles, bands,
            [](const StackModel& t, double cosine) { return t.specular_albedo(cosine); }, stop);
    });
}

Eigen::VectorXd internal_reflectance(const LayerStack& stack, const Doubles& nm) {
    const auto bands = to_vector(nm);
    return interruptible([&](StopFlag stop) -> Eigen::VectorXd {
        return table_of(
                   stack, {0.0}, bands,
                   [](const StackModel& t, double) { return t.internal_reflectance(); }, stop)
            .transpose();
    });
}

std::string plot(const LayerStack& stack, const std::string& title, double from, double to) {
    std::vector<double> nm;
    for (int k = 0; k <= 48; ++k)
        nm.push_back(from + (to - from) * k / 48.0);
    std::vector<double> straight, oblique, inside;
    for (const double at : nm) {
        const auto transport = adding_transport(stack_at(stack, at));
        straight.push_back(transport->transmission(1.0));
        oblique.push_back(transport->transmission(cosine_of(60.0)));
        inside.push_back(transport->internal_reflectance());
    }
    return svg::line_plot(
        {.title = title, .x_label = "wavelength / nm", .y_label = "share of flux"},
        {{"reaches the substrate, 0 degrees", nm, straight},
         {"the same, 60 degrees", nm, oblique},
         {"sent back to the substrate", nm, inside}});
}

} // namespace

void bind_stacks(py::module_& module) {
    py::class_<LayerStack, StackPointer>(module, "LayerStack")
        .def_static("load", &load)
        .def_property_readonly("count", [](const LayerStack& stack) { return stack.layers.size(); })
        .def("transmission", &transmission)
        .def("specular_albedo", &specular_albedo)
        .def("internal_reflectance", &internal_reflectance)
        .def("plot", &plot);
    module.def("effective_matrix", &effective_matrix);
}

} // namespace reradiant::python
