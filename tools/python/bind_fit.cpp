#include "host/base/logging.h"
#include "host/base/output_ending.h"
#include "host/base/output_file.h"
#include "host/fit/result/fit_report.h"
#include "host/fit/result/fit_summary.h"
#include "host/fit/synth/synth_recipe.h"
#include "reradiant/error.h"
#include "reradiant/fit.h"
#include "reradiant/reradiation.h"
#include "reradiant/synth.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace py = pybind11;

namespace reradiant::python {

namespace {

using DataPointer = std::shared_ptr<BispectralData>;

/// A fit and the data that it was made of, which its report shows too.
struct Fit {
    BispectralData data;
    FitResult result;
};

DataPointer data_from_matrix(const ReradiationMatrix& matrix, const std::string& name) {
    auto data = std::make_shared<BispectralData>();
    data->file = name;
    data->emission = matrix.emission;
    data->excitation = matrix.excitation;
    data->anti_stokes_allowed = matrix.anti_stokes_allowed;
    data->geometry = matrix.geometry;
    data->blocks.push_back({std::nullopt, matrix.values,
                            Eigen::MatrixXd::Constant(matrix.values.rows(), matrix.values.cols(),
                                                      std::numeric_limits<double>::quiet_NaN())});
    if (data->measured_count() == 0)
        throw_input_error({}, name + ": no entry was measured", "some entries must be numbers");
    return data;
}

FitSettings settings_from(const py::dict& given) {
    FitSettings settings;
    settings.model = fit_model_from_name(given["model"].cast<std::string>());
    settings.loss = robust_loss_from_name(given["loss"].cast<std::string>());
    settings.rank = given["rank"].cast<std::optional<int>>();
    settings.smooth_nm = given["smooth_nm"].cast<std::optional<double>>();
    settings.spill_nm = given["spill_nm"].cast<std::optional<double>>();
    settings.mask = mask_rules_from_text(given["mask"].cast<std::string>());
    settings.anti_stokes = given["anti_stokes"].cast<bool>();
    settings.unknown = unknown_layers_from_names(given["unknown"].cast<std::vector<std::string>>());
    settings.seed = given["seed"].cast<unsigned>();
    settings.solver.most_seconds = given["most_seconds"].cast<double>();
    settings.solver.most_iterations = given["most_iterations"].cast<int>();
    settings.threads = given["threads"].cast<int>();
    settings.covariance = settings.model != FitModel::Matrix;
    if (!given["stack"].is_none())
        settings.stack = given["stack"].cast<LayerStack>();
    return settings;
}

std::shared_ptr<Fit> fit_data(const BispectralData& data, const py::dict& given) {
    FitSettings settings = settings_from(given);
    return std::make_shared<Fit>(interruptible([&](StopFlag stop) {
        settings.solver.stop = stop;
        Fit fit{data, fit_reradiation(data, settings)};
        if (!fit.result.shortfall.empty())
            logging::warn("{}", fit.result.shortfall);
        return fit;
    }));
}

py::tuple synthesise_recipe(const py::object& recipe, unsigned seed) {
    const Source source = source_from(recipe);
    const auto made = interruptible([&](StopFlag) {
        const SynthRecipe read = source.table ? synth_recipe_from_table(*source.table, source.file)
                                              : read_synth_recipe(source.file);
        return std::pair(synthesise(read, seed), synth_truth(read));
    });
    return py::make_tuple(std::make_shared<BispectralData>(made.first.data),
                          std::make_shared<ReradiationMatrix>(made.second), made.first.peak,
                          made.first.noise_rms);
}

py::list blocks_of(const BispectralData& data) {
    py::list blocks;
    for (const BispectralBlock& block : data.blocks) {
        const auto& at = block.geometry;
        const py::object geometry =
            at ? py::object(py::make_tuple(at->theta_i_deg, at->theta_o_deg, at->phi_deg))
               : py::object(py::none());
        blocks.append(py::make_tuple(geometry, block.value, block.sigma));
    }
    return blocks;
}

void bind_data(py::module_& module) {
    py::class_<BispectralData, DataPointer>(module, "BispectralData")
        .def_static("read",
                    [](const std::string& file, const TableForm& form) {
                        auto data =
                            std::make_shared<BispectralData>(read_bispectral_data(file, form));
                        pass_messages_on();
                        return data;
                    })
        .def_static("from_matrix", &data_from_matrix)
        .def_property_readonly("emission",
                               [](const BispectralData& d) { return grid_tuple(d.emission); })
        .def_property_readonly("excitation",
                               [](const BispectralData& d) { return grid_tuple(d.excitation); })
        .def_readonly("anti_stokes_allowed", &BispectralData::anti_stokes_allowed)
        .def("blocks", &blocks_of)
        .def("write", [](const BispectralData& d, const std::string& file) {
            check_output_file(file);
            require_output_ending(file, {".csv"}, "BispectralData.write");
            write_bispectral_data(file, d);
        });
}

} // namespace

void bind_fit(py::module_& module) {
    bind_data(module);
    py::class_<Fit, std::shared_ptr<Fit>>(module, "Fit")
        .def_property_readonly(
            "matrix",
            [](const Fit& fit) { return std::make_shared<ReradiationMatrix>(fit.result.matrix); })
        .def_property_readonly("sigma", [](const Fit& fit) { return fit.result.sigma; })
        .def_property_readonly("covariance",
                               [](const Fit& fit) -> std::shared_ptr<MatrixCovariance> {
                                   if (!fit.result.covariance)
                                       return nullptr;
                                   return std::make_shared<MatrixCovariance>(
                                       *fit.result.covariance);
                               })
        .def_property_readonly("masked",
                               [](const Fit& fit) -> Eigen::MatrixXd {
                                   const FitResult& result = fit.result;
                                   return result.mask.any()
                                              ? result.mask.entries
                                              : Eigen::MatrixXd::Zero(result.matrix.values.rows(),
                                                                      result.matrix.values.cols());
                               })
        .def_property_readonly("emission", [](const Fit& fit) { return fit.result.emission.value; })
        .def_property_readonly("excitation",
                               [](const Fit& fit) { return fit.result.excitation.value; })
        .def_property_readonly("failure", [](const Fit& fit) { return fit.result.failure; })
        .def("summary", [](const Fit& fit) { return python_value(fit_summary(fit.result)); })
        .def("write_report", [](const Fit& fit, const std::string& file) {
            check_output_file(file);
            check_output_ending(file, {".html"}, "Fit.write_report");
            write_fit_report(file, fit.data, fit.result);
        });
    module.def("fit", &fit_data);
    module.def("synthesise", &synthesise_recipe);
}

} // namespace reradiant::python
