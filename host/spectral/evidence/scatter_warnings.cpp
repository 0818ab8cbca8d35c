#include "host/spectral/evidence/scatter_warnings.h"

#include "host/spectral/evidence/scatter_detection.h"

namespace reradiant {

std::vector<std::string> scatter_warnings(const ReradiationMatrix& matrix) {
    std::vector<std::string> warnings;
    if (matrix.kind == MatrixKind::Measured)
        for (const FoundScatter& found :
             find_scatter(matrix, {matrix.emission.step_nm, matrix.anti_stokes_allowed}))
            warnings.push_back(scatter_text(found) +
                               " counts as fluorescence; a fit leaves it out");
    return warnings;
}

} // namespace reradiant
