#include "host/study/study/study_store.h"

#include "host/base/atomic_file.h"
#include "host/film/colour_image.h"
#include "reradiant/colour.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace reradiant {

namespace {

/// A text as a field of a CSV: quoted where it holds a comma, a quote or a line's end.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char character : text)
        quoted += character == '"' ? std::string("\"\"") : std::string(1, character);
    return quoted + "\"";
}

/// Nothing stands for what is not known.
std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

/// Bands of all measurements: a swept matrix may bring its own.
std::set<double> all_bands_nm(const StudyResult& result) {
    std::set<double> all;
    for (const CellResult& cell : result.cells)
        if (cell.measurement)
            for (const double nm : cell.measurement->bands.centres_nm())
                all.insert(nm);
    return all;
}

std::string colour_fields(const SeenColour& colour, const WavelengthGrid& bands,
                          const std::set<double>& columns_nm) {
    std::string text = csv_field(colour.illuminant);
    for (const double value :
         {colour.theta_i_deg, colour.theta_o_deg, colour.phi_deg, colour.xyz[0], colour.xyz[1],
          colour.xyz[2], colour.lab[0], colour.lab[1], colour.lab[2], colour.quantum_yield,
          colour.reflected, colour.transmitted, colour.guided})
        text += fmt::format(",{}", csv_number(value));
    const std::vector<double> centres = bands.centres_nm();
    for (const double nm : columns_nm) {
        const auto place = std::find(centres.begin(), centres.end(), nm);
        text += ",";
        if (place != centres.end())
            text += csv_number(colour.beta_t[static_cast<std::size_t>(place - centres.begin())]);
    }
    return text;
}

/// Mean of an image; white is D65 with Y = 1, shown as 100.
std::string image_fields(const CellResult& cell) {
    const std::vector<Xyz> pixels = xyz_image(read_spectral_exr(cell.folder / "image.exr"));
    Xyz mean{}, white = xyz_of(illuminant_with_luminance("D65", 100.0));
    for (const Xyz& pixel : pixels)
        for (std::size_t channel = 0; channel < 3; ++channel)
            mean[channel] += 100.0 * pixel[channel] / static_cast<double>(pixels.size());
    const auto lab = xyz_to_lab(mean, white);
    return fmt::format(",,,,{},{},{},{},{},{},,,,", csv_number(mean[0]), csv_number(mean[1]),
                       csv_number(mean[2]), csv_number(lab[0]), csv_number(lab[1]),
                       csv_number(lab[2]));
}

} // namespace

void write_study_table(const std::filesystem::path& file, const Study& study,
                       const StudyResult& result) {
    std::string head = "cell";
    for (const Sweep& sweep : study.sweeps)
        head += fmt::format(",{}", csv_field(sweep.label));
    head +=
        ",source,illuminant,theta_i_deg,theta_o_deg,phi_deg,X,Y,Z,L,a,b,quantum_yield,reflected,"
        "transmitted,guided";
    const std::set<double> columns_nm = all_bands_nm(result);
    for (const double nm : columns_nm)
        head += fmt::format(",beta_T_{:g}nm", nm);
    std::string rows;
    for (const CellResult& cell : result.cells) {
        std::string front = std::to_string(cell.index);
        for (const std::string& label : cell.labels)
            front += fmt::format(",{}", csv_field(label));
        if (cell.has_image && !cell.failed())
            rows += fmt::format("{},rendered,{}\n", front,
                                image_fields(cell) + std::string(columns_nm.size(), ','));
        if (!cell.measurement)
            continue;
        for (const SeenColour& colour : cell.measurement->colours)
            rows += fmt::format("{},measured,{}\n", front,
                                colour_fields(colour, cell.measurement->bands, columns_nm));
    }
    write_text_atomically(file, head + "\n" + rows);
}

} // namespace reradiant
