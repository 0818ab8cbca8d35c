#pragma once

#include "host/spectral/colour/lamp.h"
#include "reradiant/colour_of_matrix.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// The command line of `colour`.
struct ColourOptions {
    /// Matrices, materials, measurements of `measure`.
    std::vector<std::filesystem::path> samples;
    std::vector<std::string> presets; ///< further samples, by name
    std::filesystem::path against, polygons, plot, csv, report;
    std::filesystem::path covariance, standard_errors; ///< of the one sample; one at most
    std::string geometry;                              ///< may be empty
    std::vector<std::string> illuminants;
    std::vector<std::filesystem::path> lamp_files;
    std::vector<std::string> observer_names{"1931-2"};
    std::optional<double> uv_cut_nm;
    std::vector<Lamp> lamps; ///< of the names, and then of the files
    std::vector<Observer> observers;
    unsigned seed = 0; ///< of drawn matrices
    bool e308 = false, plain = false, table = false;

    std::size_t sample_count() const { return samples.size() + presets.size(); }
    ColourSum sum() const {
        if (e308)
            return ColourSum::E308;
        return plain ? ColourSum::Bands : ColourSum::Automatic;
    }
};

/// Fills in the lamps and observers from their names and files. Input Error for those that there
/// are not, and for two lamps of one name.
void read_conditions(ColourOptions& options);

} // namespace reradiant
