#include "host/report/svg.h"
#include "host/spectral/text/wavelength_unit.h"
#include "reradiant/colour.h"
#include "reradiant/spectral_files.h"
#include "reradiant/spectrum.h"
#include "tools/python/bindings.h"
#include "tools/python/values.h"

#include <pybind11/stl.h>

#include <algorithm>

namespace py = pybind11;

namespace reradiant::python {

namespace {

/// The range in nm that a scene file takes wavelengths from (CHECKED_FROM_NM and CHECKED_TO_NM of
/// host/scene/toml/spectrum_reader.cpp).
constexpr int sampled_from_nm = 200, sampled_to_nm = 1000;

/// Returns a spectrum as a SPECTRUM of a scene file: its boxes as lines, the rest as a table with
/// every node of the spectrum's own tables and, for parts that curve, a node each nm.
py::object scene_form(const Spectrum& spectrum) {
    py::list terms;
    const Spectrum smooth = spectrum.without_lines();
    if (smooth.is_constant()) {
        terms.append(smooth(550.0));
    } else {
        std::vector<double> nm = smooth.breakpoints_nm();
        for (int at = sampled_from_nm; at <= sampled_to_nm; ++at)
            nm.push_back(at);
        std::sort(nm.begin(), nm.end());
        nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
        nm.erase(nm.begin(), std::lower_bound(nm.begin(), nm.end(), 1.0));
        terms.append(py::dict(py::arg("nm") = nm, py::arg("value") = smooth.at(nm)));
    }
    for (const SpectralLine& line : spectrum.lines())
        terms.append(py::dict(py::arg("line_nm") = line.centre_nm,
                              py::arg("width_nm") = line.width_nm,
                              py::arg("scale") = line.integral));
    return terms.size() == 1 ? py::object(terms[0]) : py::object(terms);
}

std::string plot(const Spectrum& spectrum, const std::string& title, double from, double to) {
    std::vector<double> nm;
    for (int k = 0; k <= 400; ++k)
        nm.push_back(from + (to - from) * k / 400.0);
    return svg::line_plot({.title = title, .x_label = "wavelength / nm", .y_label = "value"},
                          {{"", nm, spectrum.at(nm)}});
}

/// Series are (label, x, y).
std::string line_plot(const std::string& title, const std::string& x_label,
                      const std::string& y_label, bool log_x, bool log_y, const py::list& given) {
    std::vector<svg::Series> series;
    for (const py::handle entry : given) {
        const auto one = entry.cast<py::tuple>();
        series.push_back({one[0].cast<std::string>(), to_vector(one[1].cast<Doubles>()),
                          to_vector(one[2].cast<Doubles>())});
    }
    return svg::line_plot(
        {.title = title, .x_label = x_label, .y_label = y_label, .log_x = log_x, .log_y = log_y},
        series);
}

} // namespace

void bind_spectra(py::module_& module) {
    module.def("line_plot", &line_plot);
    py::class_<Spectrum>(module, "Spectrum")
        .def_static("constant", &Spectrum::constant)
        .def_static("table",
                    [](const Doubles& nm, const Doubles& value) {
                        const Spectrum made = Spectrum::table(to_vector(nm), to_vector(value));
                        require_plausible_range(nm.data()[0], nm.data()[nm.size() - 1],
                                                UnitSource::Fixed, {});
                        return made;
                    })
        .def_static("gaussian", &Spectrum::gaussian)
        .def_static("line", &Spectrum::line)
        .def_static("blackbody", &Spectrum::blackbody)
        .def_static("illuminant", &illuminant)
        .def_static("illuminant_with_luminance", &illuminant_with_luminance)
        .def_static("rgb",
                    [](double r, double g, double b) {
                        return reflectance_from_rgb({r, g, b});
                    })
        .def_static("read", [](const std::string& file) { return read_spectrum(file); })
        .def("at", [](const Spectrum& spectrum,
                      const Doubles& nm) { return to_array(spectrum.at(to_vector(nm))); })
        .def("average", &Spectrum::average)
        .def("add",
             [](const Spectrum& spectrum, const Spectrum& other) {
                 Spectrum sum = spectrum;
                 return sum += other;
             })
        .def("scaled", &Spectrum::scaled)
        .def("xyz", [](const Spectrum& spectrum) { return xyz_of(spectrum); })
        .def("scene_form", &scene_form)
        .def("plot", &plot);
}

} // namespace reradiant::python
