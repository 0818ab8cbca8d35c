#include "tools/python/values.h"

namespace py = pybind11;

namespace reradiant::python {

namespace {

toml::table table_from(const py::dict& values);

template <typename Add>
void with_toml_value(const py::handle& value, const Add& add);

toml::array array_from(const py::list& values) {
    toml::array array;
    for (const py::handle value : values)
        with_toml_value(value, [&](auto&& node) { array.push_back(std::move(node)); });
    return array;
}

/// The types that reradiant/_plain.py leaves; bool is an int to Python, so it comes first.
template <typename Add>
void with_toml_value(const py::handle& value, const Add& add) {
    if (py::isinstance<py::bool_>(value))
        add(value.cast<bool>());
    else if (py::isinstance<py::int_>(value))
        add(value.cast<std::int64_t>());
    else if (py::isinstance<py::float_>(value))
        add(value.cast<double>());
    else if (py::isinstance<py::str>(value))
        add(value.cast<std::string>());
    else if (py::isinstance<py::dict>(value))
        add(table_from(py::reinterpret_borrow<py::dict>(value)));
    else
        add(array_from(py::reinterpret_borrow<py::list>(value)));
}

toml::table table_from(const py::dict& values) {
    toml::table table;
    for (const auto& [key, value] : values) {
        const std::string name = key.cast<std::string>();
        with_toml_value(value, [&](auto&& node) { table.insert(name, std::move(node)); });
    }
    return table;
}

} // namespace

Source source_from(const py::object& argument) {
    if (py::isinstance<py::str>(argument))
        return {std::nullopt, argument.cast<std::string>()};
    const auto pair = argument.cast<py::tuple>();
    return {table_from(pair[0].cast<py::dict>()), pair[1].cast<std::string>()};
}

py::object python_value(const nlohmann::ordered_json& value) {
    if (value.is_null())
        return py::none();
    if (value.is_boolean())
        return py::bool_(value.get<bool>());
    if (value.is_number_integer())
        return py::int_(value.get<std::int64_t>());
    if (value.is_number())
        return py::float_(value.get<double>());
    if (value.is_string())
        return py::str(value.get<std::string>());
    if (value.is_array()) {
        py::list list;
        for (const auto& element : value)
            list.append(python_value(element));
        return list;
    }
    py::dict dict;
    for (const auto& [key, element] : value.items())
        dict[py::str(key)] = python_value(element);
    return dict;
}

std::vector<double> to_vector(const Doubles& values) {
    return {values.data(), values.data() + values.size()};
}

Doubles to_array(const std::vector<double>& values) {
    return Doubles(static_cast<py::ssize_t>(values.size()), values.data());
}

WavelengthGrid grid_from(const py::tuple& numbers) {
    return {numbers[0].cast<double>(), numbers[1].cast<double>(), numbers[2].cast<int>()};
}

py::tuple grid_tuple(const WavelengthGrid& grid) {
    return py::make_tuple(grid.from_nm, grid.step_nm, grid.count);
}

} // namespace reradiant::python
