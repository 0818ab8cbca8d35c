#pragma once

#include "reradiant/wavelength_grid.h"

#include <nlohmann/json.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace reradiant::python {

using Doubles = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A `Source` is the input of a call: a file, or a table that stands for one. Paths in the table
/// start at the folder of `file`, which then is only a name.
struct Source {
    std::optional<toml::table> table;
    std::filesystem::path file;
};

/// Reads a Source from a file name (str) or from (dict of plain Python values, name), as
/// reradiant/_plain.py makes them.
Source source_from(const pybind11::object& argument);
pybind11::object python_value(const nlohmann::ordered_json& value);

std::vector<double> to_vector(const Doubles& values);
Doubles to_array(const std::vector<double>& values);
/// (FROM, STEP, COUNT)
WavelengthGrid grid_from(const pybind11::tuple& numbers);
pybind11::tuple grid_tuple(const WavelengthGrid& grid);

/// (shape) view of memory that `owner` keeps alive.
template <typename Number>
pybind11::array_t<Number> view(Number* data, const std::vector<pybind11::ssize_t>& shape,
                               const pybind11::object& owner) {
    return pybind11::array_t<Number>(shape, data, owner);
}

} // namespace reradiant::python
