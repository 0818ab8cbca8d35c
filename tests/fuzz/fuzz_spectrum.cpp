#include "reradiant/spectral_files.h"
#include "tests/fuzz/check_spectrum.h"

// A spectrum of any format that the file says it is of; two columns (.spd and the CSV of spectra),
// and three as metals and observers have them.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const auto file = fuzz::put("input.spd", fuzz::text_of(bytes, size));
    fuzz::read_or_refuse([&] {
        const Spectrum spectrum = read_spectrum(file);
        for (const double nm : {300.0, 555.0, 780.0})
            fuzz::require_finite(spectrum(nm), "spectrum");
        fuzz::require_finite(spectrum.average(300.0, 780.0), "mean of a spectrum");
    });
    fuzz::read_or_refuse([&] { fuzz::check_spectrum(read_spectrum_table(file)); });
    fuzz::read_or_refuse([&] { fuzz::check_spectrum(read_number_table(file, 3)); });
    return 0;
}
