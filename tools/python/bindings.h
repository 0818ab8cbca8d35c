#pragma once

#include <pybind11/pybind11.h>

/// Each bind_ function adds one part of the library to the module `reradiant._library`. The
/// functions of that module trust their arguments; the Python files beside them check what users
/// give.
namespace reradiant::python {

void bind_spectra(pybind11::module_& module);
void bind_matrices(pybind11::module_& module);
void bind_stacks(pybind11::module_& module);
void bind_images(pybind11::module_& module);
void bind_render(pybind11::module_& module);
void bind_measure(pybind11::module_& module);
void bind_fit(pybind11::module_& module);
void bind_colour(pybind11::module_& module);

} // namespace reradiant::python
