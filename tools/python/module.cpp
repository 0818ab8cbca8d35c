#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace py = pybind11;

namespace reradiant::python {

namespace {

/// Raises reradiant.InputError or reradiant.RunError (reradiant/errors.py) with the place.
void raise(const Error& error) {
    const SourcePosition& at = error.position();
    const auto known = [](int number) -> py::object {
        return number > 0 ? py::object(py::int_(number)) : py::object(py::none());
    };
    const py::module_ errors = py::module_::import("reradiant.errors");
    const py::object type =
        errors.attr(error.kind() == Error::Kind::Input ? "InputError" : "RunError");
    const py::object file = at.file.empty() ? py::object(py::none()) : py::object(py::str(at.file));
    const py::object exception = type(error.what(), file, known(at.line), known(at.column));
    PyErr_SetObject(type.ptr(), exception.ptr());
}

void translate_exceptions() {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const Error& error) {
            raise(error);
        } catch (const std::invalid_argument& error) {
            raise(Error(Error::Kind::Input, {}, error.what()));
        }
    });
}

} // namespace

} // namespace reradiant::python

PYBIND11_MODULE(_library, module) {
    using namespace reradiant::python;
    namespace py = pybind11;
    module.doc() = "The C++ library beneath reradiant; use the functions of reradiant instead.";
    module.attr("version") = RERADIANT_VERSION;
    module.attr("pybind11_version") =
        py::make_tuple(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
    translate_exceptions();
    install_log();
    module.def("preset_names", &reradiant::preset_names);
    bind_spectra(module);
    bind_matrices(module);
    bind_stacks(module);
    bind_images(module);
    bind_render(module);
    bind_measure(module);
    bind_colour(module);
    bind_fit(module);
}
