#include "host/fit/dye/dye_problem.h"

#include "host/fit/stack/stack_response.h"
#include "host/measure/measure_substrate.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Index = Eigen::Index;

void check_material(const DyeFitSettings& settings) {
    const Material& material = settings.material;
    const std::size_t layers = material.stack.layers.size();
    const std::string file = material.position.file;
    if (settings.layer >= layers)
        throw_input_error({file},
                          fmt::format("--dye {}: the stack has {} layer{}", settings.layer + 1,
                                      layers, layers == 1 ? "" : "s"),
                          layers == 0
                              ? "give a [[material.layer]] that holds the dye"
                              : fmt::format("name one from 1 (the air side) to {}", layers));
    if (material.substrate.type == SubstrateType::OrenNayar ||
        material.substrate.type == SubstrateType::Conductor)
        throw_input_error({file}, "dyes are known above a Lambertian substrate or in a sheet alone",
                          "give type = \"lambert\" or \"none\"");
    if (std::ranges::any_of(material.stack.layers,
                            [](const Layer& layer) { return layer.flakes.has_value(); }))
        throw_input_error({file}, "layers with flakes cannot be fitted", "leave the flakes out");
    if (settings.fits_substrate && material.stack.is_sheet())
        throw_input_error({file}, "a sheet has no substrate that could be fitted",
                          "leave --substrate fitted out");
}

void check_units(const DyeFitSettings& settings) {
    if (settings.lamp && !settings.is_arbitrary_unit)
        throw_input_error({},
                          "--lamp contradicts --unit radiance-factor: such data are relative "
                          "to the lamp already",
                          "leave --lamp out, or say --unit arbitrary");
    if (settings.fits_substrate && settings.is_arbitrary_unit)
        throw_input_error({},
                          "with --unit arbitrary and --substrate fitted neither the data's "
                          "scale nor what they could be scaled by is known",
                          "give the substrate, or data in radiance factors");
    if (settings.dyes && (*settings.dyes < 1 || *settings.dyes > most_fitted_dyes))
        throw_input_error({}, fmt::format("--rank {} is out of range", *settings.dyes),
                          fmt::format("with --dye it is 1 to {} dyes", most_fitted_dyes));
}

void check_list(const char* option, const std::vector<double>& list, std::size_t sets) {
    if (!list.empty() && list.size() != sets)
        throw_input_error(
            {}, fmt::format("{} has {} numbers for {} data sets", option, list.size(), sets),
            "give one for each data set, in their order");
    for (const double number : list)
        if (!(number > 0.0 && std::isfinite(number)))
            throw_input_error({}, fmt::format("{} {} is out of range", option, number),
                              "give a number above 0");
}

void check_grids(const std::vector<BispectralData>& data) {
    for (const BispectralData& other : data)
        if (other.emission != data.front().emission || other.excitation != data.front().excitation)
            throw_input_error({other.file.string()},
                              "its bands are not those of " + data.front().file.string(),
                              "measure all data sets on the same bands");
}

/// The stack without the dyes that are looked for, as thick as in one data set.
LayerStack stack_of(const DyeFitSettings& settings, std::size_t set) {
    LayerStack stack = settings.material.stack;
    stack.layers[settings.layer].dyes.clear();
    if (!settings.thickness.empty())
        stack.layers[settings.layer].thickness = settings.thickness[set];
    return stack;
}

Eigen::VectorXd lamp_on(const DyeFitSettings& settings, const WavelengthGrid& excitation) {
    Eigen::VectorXd lamp = Eigen::VectorXd::Ones(excitation.count);
    if (!settings.lamp)
        return lamp;
    for (int i = 0; i < excitation.count; ++i)
        lamp(i) = std::max(0.0, (*settings.lamp)(excitation.centre_nm(i)));
    if (!(lamp.mean() > 0.0))
        throw_input_error({}, "the lamp gives no light in any band of excitation",
                          "give the spectrum that the sample was lit by");
    return lamp / lamp.mean();
}

Eigen::MatrixXd substrate_matrix(const DyeFitSettings& settings, const WavelengthGrid& bands) {
    if (settings.material.stack.is_sheet())
        return {};
    Eigen::MatrixXd matrix = measured_substrate(settings.material.substrate, bands).matrix;
    if (settings.fits_substrate)
        matrix.diagonal().setZero();
    return matrix;
}

} // namespace

PreparedDyes prepare_dyes(const std::vector<BispectralData>& data, const DyeFitSettings& settings,
                          double largest_depth) {
    check_material(settings);
    check_units(settings);
    check_list("--thickness", settings.thickness, data.size());
    check_list("--concentration", settings.concentration, data.size());
    check_grids(data);
    const LayerStack& stack = settings.material.stack;
    // what slabs scatter at the band of the light stands in the diagonal, too, and is not modelled
    const bool with_diagonal = !stack.is_sheet() && !stack.scatters();
    PreparedDyes prepared;
    DyeProblem& problem = prepared.problem;
    for (const BispectralData& set : data)
        prepared.sets.push_back(prepare_dye_data(set, settings, with_diagonal));
    problem.bands = common_grid(data.front());
    problem.emission = {problem.bands.band_of(data.front().emission.centre_nm(0)),
                        data.front().emission.count};
    problem.excitation = {problem.bands.band_of(data.front().excitation.centre_nm(0)),
                          data.front().excitation.count};
    problem.lamp = lamp_on(settings, data.front().excitation);
    problem.fits_scale = settings.is_arbitrary_unit;
    problem.fits_substrate = settings.fits_substrate;
    set_largest_depth(prepared, settings, largest_depth);
    return prepared;
}

void set_largest_depth(PreparedDyes& prepared, const DyeFitSettings& settings,
                       double largest_depth) {
    std::vector<DyeSampleData> samples;
    for (std::size_t s = 0; s < prepared.sets.size(); ++s) {
        const DyeDataSet& set = prepared.sets[s];
        const DyeSample sample{stack_of(settings, s), settings.layer,
                               substrate_matrix(settings, prepared.problem.bands), set.views};
        const double concentration =
            settings.concentration.empty() ? 1.0 : settings.concentration[s];
        samples.push_back(
            {nullptr, concentration * sample.stack.layers[settings.layer].thickness, nullptr});
        // the thickness of a slab that is clear but for its dye changes the dye's depth alone
        const Layer& layer = sample.stack.layers[settings.layer];
        const bool is_like_the_last = s > 0 && layer.absorption.is_zero() && !layer.scatters() &&
                                      set.views == prepared.sets[s - 1].views;
        samples.back().stack =
            is_like_the_last
                ? samples[s - 1].stack
                : std::make_shared<const DyeStack>(sample, prepared.problem.bands, largest_depth);
    }
    prepared.problem.samples = std::move(samples);
    for (std::size_t s = 0; s < prepared.sets.size(); ++s)
        prepared.problem.samples[s].data = &prepared.sets[s];
}

} // namespace reradiant
