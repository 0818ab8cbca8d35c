#pragma once

#include "host/measure/measured_sample.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/text/csv_lines.h"

#include <map>
#include <string_view>
#include <vector>

namespace reradiant {

/// Reads the file of a MeasuredSample line by line.
class MeasuredSample::Reader {
public:
    Reader(MeasuredSample& sample, const std::filesystem::path& file)
        : sample_(sample), reader_(file) {}

    void read();

private:
    using Axis = std::map<double, PlacedWavelength>; ///< wavelengths with their first places

    MeasuredPart part(const TextToken& token) const;
    double wavelength(const TextToken& token, Axis& axis) const;
    void read_row(std::vector<TextToken> cells);
    void read_remark(std::string_view line);
    void read_rows();
    WavelengthGrid grid(const Axis& axis, const char* name) const;
    void place_rows();

    MeasuredSample& sample_;
    TextReader reader_;
    Axis emission_, excitation_;
};

} // namespace reradiant
