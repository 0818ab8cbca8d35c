#include "reradiant/synth.h"
#include "host/report/json_file.h"
#include "host/scene/model/named_files.h"
#include "reradiant/error.h"
#include "reradiant/reradiation.h"
#include "reradiant/spectral_files.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct SynthOptions {
    fs::path recipe, output, truth;
    std::optional<double> thickness;
};

/// Errors of meaning have no place of their own: they are placed at the recipe.
SynthResult synthesise_file(const SynthRecipe& recipe, const fs::path& file, unsigned seed) {
    try {
        return synthesise(recipe, seed);
    } catch (const std::invalid_argument& error) {
        throw_input_error({file.string()}, error.what(), "change the recipe's grids or bands");
    }
}

std::ptrdiff_t dyed_layers(const SynthRecipe& recipe) {
    return std::ranges::count_if(recipe.stack.layers, &Layer::is_dyed);
}

Json describe(const SynthOptions& options, const SynthRecipe& recipe, const SynthResult& result,
              const ReradiationMatrix& truth, unsigned seed) {
    const std::vector<double> photons = column_balance(truth).photons;
    Json yields = Json::array();
    for (const Fluorophore& fluorophore : recipe.fluorophores)
        yields.push_back(fluorophore.quantum_yield);
    Json json = {{"data", options.output.string()},
                 {"truth", options.truth.string()},
                 {"seed", seed},
                 {"emission_bands", recipe.emission.count},
                 {"excitation_bands", recipe.excitation.count},
                 {"geometries", recipe.geometries.size()},
                 {"dyed_layers", dyed_layers(recipe)},
                 {"entries", result.data.measured_count()},
                 {"peak", result.peak},
                 {"noise_rms", result.noise_rms},
                 {"noise_rms_of_peak", result.noise_rms / result.peak},
                 {"quantum_yield", yields},
                 {"largest_photon_column_sum", *std::max_element(photons.begin(), photons.end())}};
    return json;
}

/// Fits find the substrate, and know nothing of dyes above it.
void print_what_truth_leaves_out(const SynthRecipe& recipe) {
    if (recipe.stack.is_dyed())
        fmt::print("the data hold the light of dyes in {} of the layers, which the truth, the "
                   "substrate's matrix, does not\n",
                   dyed_layers(recipe));
}

/// The recipe, with another thickness of its first dyed layer where one is asked for.
SynthRecipe recipe_of(const SynthOptions& options) {
    SynthRecipe recipe = read_synth_recipe(options.recipe);
    if (!options.thickness)
        return recipe;
    const auto dyed = std::ranges::find_if(recipe.stack.layers, &Layer::is_dyed);
    if (dyed == recipe.stack.layers.end())
        throw_input_error({options.recipe.string()}, "--thickness is of a dyed layer, and none is",
                          "give the layer fluorophores, or leave --thickness out");
    dyed->thickness = *options.thickness;
    return recipe;
}

int run_synth(const SynthOptions& options, const CommonOptions& common) {
    const std::vector<NamedOutput> outputs = {
        {"-o",
         options.output,
         {".csv"},
         true,
         "`reradiant convert` makes other formats of a bare matrix"},
        {"--truth", options.truth, {".csv", ".exr", ".bfc"}, true}};
    check_outputs(common, outputs, {options.recipe});
    const SynthRecipe recipe = recipe_of(options);
    check_outputs(common, outputs, named_files());
    const SynthResult result = synthesise_file(recipe, options.recipe, common.seed);
    const ReradiationMatrix truth = synth_truth(recipe);
    write_bispectral_data(options.output, result.data);
    if (!options.truth.empty())
        write_reradiation(options.truth, truth);
    write_json(common.json, describe(options, recipe, result, truth, common.seed));
    if (common.quiet)
        return 0;
    fmt::print("{}: {} entries, {}\n", options.output.string(), result.data.measured_count(),
               recipe.geometries.empty()
                   ? std::string("the bare matrix")
                   : fmt::format("{} geometries, {} layers", recipe.geometries.size(),
                                 recipe.stack.layers.size()));
    fmt::print("largest fluorescent entry {:.6g}; noise {:.3g} rms off the diagonal, {:.3g} % of "
               "it\n",
               result.peak, result.noise_rms, 100.0 * result.noise_rms / result.peak);
    print_what_truth_leaves_out(recipe);
    return 0;
}

} // namespace

void add_synth_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<SynthOptions>();
    Command command = program.add_command(
        "synth", "Synthetic bispectral data of known fluorophores, with an instrument's noise");
    command.option("RECIPE", options->recipe, "TOML file, see tools/examples/synth-*.toml")
        .required();
    command
        .option("-o,--output", options->output,
                "CSV to write: a measured re-radiation matrix, or with [geometry] what "
                "`measure` writes, with standard errors")
        .required();
    command.option("--truth", options->truth,
                   "write the substrate's matrix without noise (.csv, .exr, .bfc)");
    command
        .option("--thickness", options->thickness,
                "of the first dyed layer, instead of the recipe's: one of a series of samples")
        .positive();
    command.footer("Examples:\n"
                   "  reradiant synth tools/examples/synth-orange.toml -o ~/orange.csv --seed 7\n"
                   "  reradiant synth tools/examples/synth-varnished.toml -o ~/data.csv "
                   "--truth ~/truth.csv");
    command.callback(
        [options, &context] { context.exit_code = run_synth(*options, context.common); });
}

} // namespace reradiant
