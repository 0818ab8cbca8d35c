#pragma once

#include "reradiant/reradiation.h"
#include "tools/commands/colour/colour_options.h"

#include <filesystem>
#include <string>
#include <vector>

namespace reradiant {

/// A `ColourSample` is what a colour is asked of, as radiance factors.
struct ColourSample {
    std::string name;       ///< the file as it was given, or the preset
    std::string short_name; ///< without the folder, where that is no other sample's
    std::filesystem::path file;
    /// In the geometry that is asked for, or that of the instrument which measured a matrix.
    ReradiationMatrix matrix;
};

/// The files of all samples that are asked for, in order. Input Error where there are none.
std::vector<std::filesystem::path> sample_files(const ColourOptions& options);

/// Reads the samples in order. Input Error for one that is given twice, for a file that is no
/// sample, and for a geometry that none of the samples can have or that one of them does not hold.
std::vector<ColourSample> read_samples(const ColourOptions& options);

/// Reads the sample of --against; `geometry` counts for what can have it.
ColourSample read_reference(const ColourOptions& options);

} // namespace reradiant
