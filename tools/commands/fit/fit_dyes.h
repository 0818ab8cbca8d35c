#pragma once

#include "reradiant/fit.h"
#include "tools/program/command.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// What `fit` is told of dyes in a layer.
struct DyeOptions {
    std::string layer; ///< empty: no dye is looked for
    std::vector<double> thickness, concentration;
    std::string unit = "radiance-factor", substrate = "known";
    std::filesystem::path lamp;
    std::optional<double> ceiling;

    /// The first of these options that was given without --dye; empty: none.
    std::string given_without_layer() const;
};

/// What such a fit reads and writes beside.
struct DyeFitFiles {
    std::vector<std::filesystem::path> data;
    std::filesystem::path stack, output, report, model_file;
};

void add_dye_options(Command& command, DyeOptions& options);

/// Runs `fit --dye` with the settings that every fit has. Returns the exit code.
int run_dye_fit(const DyeOptions& options, const DyeFitFiles& files, const FitSettings& fit,
                const CommonOptions& common);

} // namespace reradiant
