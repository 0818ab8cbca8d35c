#include "host/fit/dye/dye_fit.h"

#include "host/fit/data/measurement_reader.h"
#include "host/spectral/evidence/plausible_matrix.h"
#include "reradiant/error.h"

namespace reradiant {

BispectralData read_dye_data(const std::filesystem::path& file, bool is_arbitrary_unit) {
    BispectralData data = read_unjudged_data(file, {}, MeasuredLight::OfAll);
    require_plausible_bands(data.emission, data.excitation, file);
    for (const BispectralBlock& block : data.blocks)
        if (!is_arbitrary_unit)
            require_plausible_values(block.value, file);
    if (data.measured_count() == 0)
        throw_input_error({file.string(), 1, 1}, "no entry was measured",
                          "some entries must be numbers");
    return data;
}

} // namespace reradiant
