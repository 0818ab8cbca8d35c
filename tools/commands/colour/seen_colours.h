#pragma once

#include "host/spectral/colour/colour_report.h"
#include "tools/commands/colour/colour_options.h"
#include "tools/commands/colour/colour_samples.h"

#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// The colour of a sample under one lamp for one observer, and that of the sample that it is
/// compared with.
struct SeenColour {
    ColourReport report;
    std::optional<ColourReport> against;
};

/// A sample under every lamp, observer by observer.
struct SeenSample {
    ColourSample sample;
    std::vector<SeenColour> colours;

    bool passes_a_polygon() const;
};

/// The colours of all samples that are asked for. Input Error as read_samples, for polygons that no
/// lamp of the request can test, and for a sample of which a lamp shows nothing.
std::vector<SeenSample> see_samples(const ColourOptions& options);

/// The warnings of a sample's reports, each once.
std::vector<std::string> warnings_of(const SeenSample& sample);

/// Returns the key of a report: LAMP, or LAMP/OBSERVER where there are several observers.
std::string key_of(const ColourReport& report, const ColourOptions& options);

} // namespace reradiant
