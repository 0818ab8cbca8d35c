#pragma once

#include "host/film/region_values.h"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace reradiant {

/// What is seen at a place, and how it compares with the first place. Ratios are this place's value
/// over the first one's; standard errors take the two as independent.
struct ProbedPlace {
    ImageRegion region;
    RegionValues values;
    std::array<double, 3> lab{};                       ///< relative to the white
    std::vector<double> ratio = {}, ratio_stderr = {}; ///< per band; NaN where the first is black
    double luminance_ratio = 0.0, luminance_ratio_stderr = 0.0;
    double ciede2000 = 0.0;
};

/// All places of an image beside the white that Lab is relative to.
struct ProbedImage {
    std::string image, lamp;
    Xyz white{};
    WavelengthGrid bands;
    std::vector<ProbedPlace> places;
};

/// Probes an image; input Error for a region outside it.
ProbedImage probe(const SpectralImage& image, const std::vector<ImageRegion>& regions,
                  const Xyz& white);

nlohmann::ordered_json probe_json(const ProbedImage& probed);
/// A row a band: nm, each place's radiance and standard error (W m^-2 sr^-1 nm^-1), then the ratios
/// to the first place. What is not known is left empty.
std::string probe_csv(const ProbedImage& probed);
/// The spectra with bands of 1.96 standard errors, as SVG.
std::string probe_plot(const ProbedImage& probed);
/// What is printed: two lines a place.
std::string probe_text(const ProbedImage& probed);

} // namespace reradiant
