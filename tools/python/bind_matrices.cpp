#include "host/base/output_file.h"
#include "host/report/svg.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/evidence/plausible_matrix.h"
#include "host/spectral/spectrum/rounded_grid.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <stdexcept>

namespace py = pybind11;

namespace reradiant::python {

namespace {

using MatrixPointer = std::shared_ptr<ReradiationMatrix>;

MatrixPointer make_matrix(const Eigen::MatrixXd& values, const py::tuple& emission,
                          const py::tuple& excitation, bool measured, bool anti_stokes) {
    auto matrix = std::make_shared<ReradiationMatrix>();
    matrix->values = values;
    matrix->emission = grid_from(emission);
    matrix->excitation = grid_from(excitation);
    matrix->kind = measured ? MatrixKind::Measured : MatrixKind::Model;
    matrix->anti_stokes_allowed = anti_stokes;
    require_plausible_matrix(*matrix, {});
    warn_of_matrix("", *matrix);
    pass_messages_on();
    return matrix;
}

MatrixPointer read_matrix(const std::string& file, const TableForm& form) {
    auto matrix = std::make_shared<ReradiationMatrix>(read_reradiation(file, Gaps::Refused, form));
    warn_of_matrix(file, *matrix);
    pass_messages_on();
    return matrix;
}

MatrixPointer from_fluorophores(const py::list& fluorophores, const Spectrum& reflectance,
                                const py::tuple& emission, const py::tuple& excitation) {
    std::vector<Fluorophore> parts;
    for (const py::handle entry : fluorophores) {
        const auto one = entry.cast<py::tuple>();
        parts.push_back({one[0].cast<Spectrum>(), one[1].cast<Spectrum>(), one[2].cast<double>()});
    }
    return std::make_shared<ReradiationMatrix>(
        matrix_from_fluorophores(parts, reflectance, grid_from(emission), grid_from(excitation)));
}

py::tuple factorise(const ReradiationMatrix& matrix, int rank, double tolerance) {
    const MaskedFactors factors =
        factorise_lower(fluorescence_on_cells(matrix, matrix.emission), rank, tolerance);
    return py::make_tuple(factors.emission, factors.excitation, factors.relative_error);
}

/// The repaired matrix, and sentences on what was changed or breaks the photon balance.
py::tuple repaired(const ReradiationMatrix& matrix) {
    auto copy = std::make_shared<ReradiationMatrix>(matrix);
    std::vector<std::string> warnings;
    const std::string changes = repair_for_rendering(*copy, warnings).text();
    if (!changes.empty())
        warnings.insert(warnings.begin(), changes);
    return py::make_tuple(copy, warnings);
}

py::tuple balance(const ReradiationMatrix& matrix) {
    const ColumnBalance sums = column_balance(matrix);
    return py::make_tuple(to_array(sums.radiant), to_array(sums.photons));
}

std::string plot(const ReradiationMatrix& matrix, const std::string& title) {
    return svg::heat_map({.title = title,
                          .x_label = "excitation / nm",
                          .y_label = "emission / nm",
                          .x = matrix.excitation.centres_nm(),
                          .y = matrix.emission.centres_nm(),
                          .value = matrix.fluorescent_part()});
}

/// None for ascending centres that are not equally spaced within their rounding.
py::object rounded_grid(const Doubles& centres_nm, double rounding_nm) {
    std::vector<RoundedWavelength> centres;
    for (const double nm : to_vector(centres_nm))
        centres.push_back({nm, rounding_nm});
    try {
        return grid_tuple(grid_from_rounded_centres(centres));
    } catch (const std::invalid_argument&) {
        return py::none();
    }
}

} // namespace

void bind_matrices(py::module_& module) {
    module.def("rounded_grid", &rounded_grid);
    py::class_<TableForm>(module, "TableForm")
        .def(py::init([](const std::string& rows, const std::string& quantity,
                         const std::string& scale, const std::string& decimal,
                         const std::string& kind, bool anti_stokes) {
            return table_form({rows, quantity, scale, decimal, kind, anti_stokes});
        }));
    py::class_<ReradiationMatrix, MatrixPointer>(module, "ReradiationMatrix")
        .def(py::init(&make_matrix))
        .def_static("from_fluorophores", &from_fluorophores)
        .def_static("read", &read_matrix)
        .def("write",
             [](const ReradiationMatrix& matrix, const std::string& file) {
                 check_output_file(file);
                 write_reradiation(file, matrix);
                 pass_messages_on();
             })
        .def_property_readonly(
            "values", [](ReradiationMatrix& matrix) -> Eigen::MatrixXd& { return matrix.values; },
            py::return_value_policy::reference_internal)
        .def_property_readonly(
            "emission", [](const ReradiationMatrix& matrix) { return grid_tuple(matrix.emission); })
        .def_property_readonly(
            "excitation",
            [](const ReradiationMatrix& matrix) { return grid_tuple(matrix.excitation); })
        .def_property_readonly(
            "measured",
            [](const ReradiationMatrix& matrix) { return matrix.kind == MatrixKind::Measured; })
        .def_readonly("anti_stokes_allowed", &ReradiationMatrix::anti_stokes_allowed)
        .def("reflectance", &ReradiationMatrix::reflectance)
        .def("fluorescent_part", &ReradiationMatrix::fluorescent_part)
        .def("balance", &balance)
        .def("repaired", &repaired)
        .def("factorise", &factorise)
        .def("plot", &plot);
}

} // namespace reradiant::python
