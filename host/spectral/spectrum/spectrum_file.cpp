#include "reradiant/spectral_files.h"

#include "host/base/atomic_file.h"
#include "host/base/output_ending.h"
#include "host/spectral/files/matrix_formats.h"
#include "host/spectral/spectrum/spectrum_formats.h"
#include "host/spectral/text/text_format.h"

#include <fmt/core.h>

#include <stdexcept>

namespace reradiant {

NumberTable read_spectrum_table(const std::filesystem::path& file) {
    switch (text_format_of(file)) {
    case TextFormat::JcampDx:
        return read_jcamp(file);
    case TextFormat::Cgats:
        return read_cgats(file);
    case TextFormat::Tm27:
        return read_tm27(file);
    case TextFormat::Table:
        if (const auto at = declares_reradiation(file))
            throw_input_error(*at, "the file is a re-radiation matrix, not a spectrum",
                              "give it where a re-radiation matrix is asked for");
        return read_number_table(file, 2);
    default: // read_number_table refuses by name what is no table
        return read_number_table(file, 2);
    }
}

Spectrum read_spectrum(const std::filesystem::path& file) {
    NumberTable table = read_spectrum_table(file);
    return Spectrum::table(std::move(table.columns[0]), std::move(table.columns[1]));
}

void write_spectrum(const std::filesystem::path& file, const std::vector<double>& wavelengths_nm,
                    const std::vector<double>& values) {
    Spectrum::table(wavelengths_nm, values); // refuses what could not be read back
    const std::string ending = lower_case_ending(file);
    if (ending != ".csv" && ending != ".spd")
        throw_input_error({file.string()},
                          fmt::format("the ending '{}' is not of a spectrum", ending),
                          "use .csv or .spd");
    const bool csv = ending == ".csv";
    std::string text = csv ? "nm,value\n" : "# nm value\n";
    // fmt prints the shortest text that reads back as the same double.
    for (std::size_t i = 0; i < values.size(); ++i)
        text += fmt::format("{}{}{}\n", wavelengths_nm[i], csv ? ',' : ' ', values[i]);
    write_text_atomically(file, text);
}

} // namespace reradiant
