// Links the library: what a varnish lets in and keeps back, and the colour of a fluorescent orange.
// Prints transmission, internal reflectance and XYZ under D65.
#include "reradiant/colour_of_matrix.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "reradiant/spectral_files.h"
#include "reradiant/stack_model.h"

#include <cstdio>

int main() try {
    using namespace reradiant;
    LayerStack varnish;
    varnish.layers.push_back({.ior = Spectrum::constant(1.5)});
    const auto transport = adding_transport(stack_at(varnish, 550.0));
    std::printf("T %.6f, r %.6f\n", transport->transmission(1.0),
                transport->internal_reflectance());

    const ReradiationMatrix orange =
        read_reradiation(spectra_directory() / "reradiation" / "synthetic-orange.csv");
    const MatrixColour bare = colour_of_matrix(orange, illuminant("D65"), ColourSum::Bands);
    std::printf("XYZ %.4f %.4f %.4f\n", bare.xyz[0], bare.xyz[1], bare.xyz[2]);
    return 0;
} catch (const reradiant::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
}
