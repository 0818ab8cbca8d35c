#include "tools/commands/colour/covariance_options.h"

#include "host/spectral/covariance/colour_intervals.h"
#include "reradiant/error.h"
#include "reradiant/spectral_files.h"

#include <fmt/format.h>

#include <stdexcept>

namespace reradiant {

namespace {

MatrixCovariance read_covariance(const ColourOptions& options, const ColourSample& sample) {
    const bool is_whole = !options.covariance.empty();
    const std::filesystem::path& file = is_whole ? options.covariance : options.standard_errors;
    try {
        MatrixCovariance covariance =
            is_whole ? read_covariance_csv(file) : independent_errors(read_reradiation(file));
        require_covariance_of(sample.matrix, covariance);
        return covariance;
    } catch (const std::invalid_argument& error) {
        throw_input_error({file.string()}, error.what(),
                          fmt::format("give what belongs to {}", sample.name));
    }
}

} // namespace

void add_covariance_options(Command& command, ColourOptions& options) {
    const CommandOption errors = command.option(
        "--standard-errors", options.standard_errors,
        "matrix of the same form whose entries are standard errors, independent of each other");
    command
        .option(
            "--covariance", options.covariance,
            "what `fit --covariance` wrote of the matrix: gives 95 % intervals, by linearisation "
            "and from 1,000 drawn matrices (--seed)")
        .excludes(errors);
}

void add_intervals(const ColourOptions& options, std::vector<SeenSample>& samples) {
    if (options.covariance.empty() && options.standard_errors.empty())
        return;
    const std::string option = options.covariance.empty() ? "--standard-errors" : "--covariance";
    if (samples.size() != 1)
        throw_input_error({}, option + " is of one matrix", "give one sample with it");
    SeenSample& seen = samples.front();
    if (seen.sample.file.extension() == ".toml")
        throw_input_error({seen.sample.file.string()}, option + " is of a matrix",
                          "give the matrix that it belongs to, not a material");
    const MatrixCovariance covariance = read_covariance(options, seen.sample);
    for (SeenColour& one : seen.colours)
        for (const Lamp& lamp : options.lamps)
            if (lamp.name == one.report.illuminant)
                set_intervals(one.report, seen.sample.matrix, covariance, lamp, options.sum(),
                              options.seed);
}

} // namespace reradiant
