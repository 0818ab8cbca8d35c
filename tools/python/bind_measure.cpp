#include "host/base/output_ending.h"
#include "host/base/output_file.h"
#include "host/scene/toml/scene_table.h"
#include "reradiant/measure.h"
#include "reradiant/scene_file.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/stl.h>

#include <tbb/global_control.h>

#include <memory>

namespace py = pybind11;

namespace reradiant::python {

namespace {

MeasureRequest request_from(const py::dict& given) {
    MeasureRequest request;
    request.theta_i_deg = to_vector(given["theta_i"].cast<Doubles>());
    request.theta_o_deg = to_vector(given["theta_o"].cast<Doubles>());
    request.phi_deg = to_vector(given["phi"].cast<Doubles>());
    request.hemispherical = given["hemispherical"].cast<bool>();
    request.model = model_from_name(given["model"].cast<std::string>());
    request.samples = given["samples"].cast<long>();
    request.seed = given["seed"].cast<unsigned>();
    if (!given["bands"].is_none())
        request.bands = grid_from(given["bands"].cast<py::tuple>());
    return request;
}

/// Errors of meaning have no place of their own: they are placed at the material.
Measurement measure_source(const Source& source, const MeasureRequest& request) {
    const Material material = source.table
                                  ? material_from_table(*source.table, source.file, request.bands)
                                  : load_material(source.file, request.bands);
    try {
        return measure_material(material, request);
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Input && error.position().file.empty())
            throw_input_error({source.file.string()}, error.what());
        throw;
    }
}

/// A column of the rows as an array of its own.
template <typename Member>
Doubles column(const Measurement& measurement, Member member) {
    Doubles values(static_cast<py::ssize_t>(measurement.rows.size()));
    double* out = values.mutable_data();
    for (const MeasureRow& row : measurement.rows)
        *out++ = row.*member;
    return values;
}

py::list part_column(const Measurement& measurement) {
    py::list names;
    for (const MeasureRow& row : measurement.rows)
        names.append(part_name(row.part));
    return names;
}

py::array_t<bool> specular_column(const Measurement& measurement) {
    py::array_t<bool> values(static_cast<py::ssize_t>(measurement.rows.size()));
    bool* out = values.mutable_data();
    for (const MeasureRow& row : measurement.rows)
        *out++ = row.part == MeasuredPart::Specular;
    return values;
}

std::shared_ptr<Measurement> measure_argument(const py::object& material, const py::dict& given) {
    const Source source = source_from(material);
    MeasureRequest request = request_from(given);
    const int threads = given["threads"].cast<int>();
    return std::make_shared<Measurement>(interruptible([&](StopFlag stop) {
        std::optional<tbb::global_control> limit;
        if (threads > 0)
            limit.emplace(tbb::global_control::max_allowed_parallelism,
                          static_cast<std::size_t>(threads));
        request.stop = stop;
        return measure_source(source, request);
    }));
}

} // namespace

void bind_measure(py::module_& module) {
    py::class_<Measurement, std::shared_ptr<Measurement>>(module, "Measurement")
        .def_property_readonly("bands", [](const Measurement& m) { return grid_tuple(m.bands); })
        .def_property_readonly("model", [](const Measurement& m) { return model_name(m.model); })
        .def_readonly("hemispherical", &Measurement::hemispherical)
        .def_readonly("notes", &Measurement::notes)
        .def("columns",
             [](const Measurement& m) {
                 return py::dict(py::arg("theta_i_deg") = column(m, &MeasureRow::theta_i_deg),
                                 py::arg("theta_o_deg") = column(m, &MeasureRow::theta_o_deg),
                                 py::arg("phi_deg") = column(m, &MeasureRow::phi_deg),
                                 py::arg("lambda_i_nm") = column(m, &MeasureRow::lambda_i_nm),
                                 py::arg("lambda_o_nm") = column(m, &MeasureRow::lambda_o_nm),
                                 py::arg("value") = column(m, &MeasureRow::value),
                                 py::arg("stderr") = column(m, &MeasureRow::standard_error),
                                 py::arg("part") = part_column(m),
                                 py::arg("specular") = specular_column(m));
             })
        .def("write", [](const Measurement& m, const std::string& file) {
            check_output_file(file);
            check_output_ending(file, {".csv"}, "Measurement.write");
            write_measurement(file, m);
        });
    module.def("measure", &measure_argument);
}

} // namespace reradiant::python
