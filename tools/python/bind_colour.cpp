#include "host/base/output_file.h"
#include "host/measure/geometry_matrix.h"
#include "host/measure/measured_sample.h"
#include "host/scene/toml/scene_table.h"
#include "host/spectral/colour/colour_report.h"
#include "host/spectral/colour/lamp.h"
#include "host/spectral/covariance/colour_intervals.h"
#include "host/spectral/evidence/scatter_warnings.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

namespace py = pybind11;

namespace reradiant::python {

namespace {

using MatrixPointer = std::shared_ptr<ReradiationMatrix>;
using CovariancePointer = std::shared_ptr<MatrixCovariance>;

Lamp lamp_from_table(const std::string& name, const Doubles& nm, const Doubles& value) {
    const std::vector<double> at = to_vector(nm);
    return {.name = name,
            .light = cut_to(Spectrum::table(at, to_vector(value)), at.front(), at.back())};
}

MatrixPointer matrix_of_material(const py::object& argument, const std::string& geometry) {
    const Source source = source_from(argument);
    const ViewingGeometry seen = viewing_geometry(geometry);
    return std::make_shared<ReradiationMatrix>(interruptible([&](StopFlag) {
        const Material material = source.table ? material_from_table(*source.table, source.file)
                                               : load_material(source.file);
        return geometry_matrix_of(source.file, material, seen);
    }));
}

MatrixPointer matrix_of_measurement(const std::string& file, const std::string& geometry) {
    auto matrix = std::make_shared<ReradiationMatrix>(
        MeasuredSample(file).seen_in(viewing_geometry(geometry)));
    pass_messages_on();
    return matrix;
}

/// What a call of `colour` says beside the matrix.
struct Question {
    std::vector<Lamp> lamps;
    std::vector<Observer> observers;
    ColourSum sum = ColourSum::Automatic;
    MatrixPointer against;
    CovariancePointer covariance;
    std::vector<ColourPolygon> polygons;
    unsigned seed = 0;

    explicit Question(const py::dict& given)
        : lamps(given["lamps"].cast<std::vector<Lamp>>()),
          against(given["against"].cast<MatrixPointer>()),
          covariance(given["covariance"].cast<CovariancePointer>()),
          seed(given["seed"].cast<unsigned>()) {
        for (const auto& name : given["observers"].cast<std::vector<std::string>>())
            observers.push_back(observer_named(name));
        if (const auto e308 = given["e308"].cast<std::optional<bool>>())
            sum = *e308 ? ColourSum::E308 : ColourSum::Bands;
        if (const auto file = given["polygons"].cast<std::optional<std::string>>())
            polygons = read_colour_polygons(*file);
    }
};

/// The report under one lamp, without what it takes other lamps to say.
ColourReport report_of(const ReradiationMatrix& matrix, ColourReporter& reporter,
                       const Question& question) {
    ColourReport report = reporter.report_of(matrix, scatter_warnings(matrix));
    if (question.covariance)
        set_intervals(report, matrix, *question.covariance, reporter.lamp(), question.sum,
                      question.seed);
    test_polygons(report, question.polygons);
    return report;
}

py::dict colour(const ReradiationMatrix& matrix, const py::dict& given) {
    const Question question(given);
    py::dict answers;
    for (const Observer observer : question.observers) {
        std::optional<ColourReport> first, first_against;
        for (const Lamp& lamp : question.lamps) {
            ColourReporter reporter(lamp, question.sum, observer);
            ColourReport report = report_of(matrix, reporter, question);
            if (question.against) {
                const ColourReport against = reporter.report_of(*question.against, {});
                compare_with(report, against);
                if (first)
                    report.metamerism = metamerism_index(first_against->colour, first->colour,
                                                         against.colour, report.colour);
                else
                    first_against = against;
            }
            const std::string key = report_key(report, question.observers.size());
            answers[py::str(key)] = python_value(colour_report_json(report));
            if (!first)
                first = std::move(report);
        }
    }
    return answers;
}

CovariancePointer make_covariance(const py::tuple& emission, const py::tuple& excitation,
                                  const Eigen::MatrixXd& independent, const Doubles& directions) {
    auto covariance = std::make_shared<MatrixCovariance>();
    covariance->emission = grid_from(emission);
    covariance->excitation = grid_from(excitation);
    covariance->independent = independent;
    const auto all = directions.unchecked<3>();
    covariance->directions.resize(independent.size(), all.shape(0));
    for (py::ssize_t k = 0; k < all.shape(0); ++k)
        for (py::ssize_t i = 0; i < all.shape(2); ++i)
            for (py::ssize_t o = 0; o < all.shape(1); ++o)
                covariance->directions(o + i * all.shape(1), k) = all(k, o, i);
    return covariance;
}

py::array_t<double> directions_of(const MatrixCovariance& covariance) {
    const Eigen::Index rows = covariance.emission.count, columns = covariance.excitation.count;
    py::array_t<double> directions({covariance.directions.cols(), rows, columns});
    auto all = directions.mutable_unchecked<3>();
    for (Eigen::Index k = 0; k < covariance.directions.cols(); ++k)
        for (Eigen::Index o = 0; o < rows; ++o)
            for (Eigen::Index i = 0; i < columns; ++i)
                all(k, o, i) = covariance.directions(o + i * rows, k);
    return directions;
}

void bind_covariance(py::module_& module) {
    py::class_<MatrixCovariance, CovariancePointer>(module, "MatrixCovariance")
        .def(py::init(&make_covariance))
        .def_static("read",
                    [](const std::string& file) {
                        return std::make_shared<MatrixCovariance>(read_covariance_csv(file));
                    })
        .def("write",
             [](const MatrixCovariance& covariance, const std::string& file) {
                 check_output_file(file);
                 write_covariance_csv(file, covariance);
             })
        .def("require_of",
             [](const MatrixCovariance& covariance, const ReradiationMatrix& matrix) {
                 require_covariance_of(matrix, covariance);
             })
        .def_property_readonly("emission",
                               [](const MatrixCovariance& c) { return grid_tuple(c.emission); })
        .def_property_readonly("excitation",
                               [](const MatrixCovariance& c) { return grid_tuple(c.excitation); })
        .def_readonly("independent", &MatrixCovariance::independent)
        .def_property_readonly("directions", &directions_of)
        .def("standard_errors", &MatrixCovariance::standard_errors);
}

} // namespace

void bind_colour(py::module_& module) {
    py::class_<Lamp>(module, "Lamp")
        .def_static("from_text", &lamp_from_text)
        .def_static("read", [](const std::string& file) { return read_lamp(file); })
        .def_static("from_light",
                    [](const std::string& name, const Spectrum& light) {
                        return Lamp{.name = name, .light = light};
                    })
        .def_static("from_table", &lamp_from_table)
        .def_readwrite("name", &Lamp::name)
        .def("without_ultraviolet", &without_ultraviolet);
    bind_covariance(module);
    module.def("matrix_of_material", &matrix_of_material);
    module.def("matrix_of_measurement", &matrix_of_measurement);
    module.def("colour", &colour);
}

} // namespace reradiant::python
