#include "reradiant/colour_of_matrix.h"

#include "host/spectral/colour/lamp_colours.h"

namespace reradiant {

LampError plain_sums_misjudge(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              const ColourConditions& conditions) {
    return LampColours(illuminant, ColourSum::Automatic, conditions).plain_sums_misjudge(matrix);
}

MatrixColour colour_of_matrix(const ReradiationMatrix& matrix, const Spectrum& illuminant,
                              ColourSum sum, const ColourConditions& conditions) {
    return LampColours(illuminant, sum, conditions).colour_of(matrix);
}

} // namespace reradiant
