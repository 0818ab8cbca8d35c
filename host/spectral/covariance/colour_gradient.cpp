#include "host/spectral/covariance/colour_gradient.h"

#include "host/spectral/colour/band_sums.h"
#include "host/spectral/colour/colour_indices.h"

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Weights of what is reflected and of what is re-radiated per emission band, a column a sum.
struct BandWeights {
    Matrix reflected, luminescent;
};

void add_r457(const WavelengthGrid& bands, const Spectrum& illuminant, bool at_nanometres,
              BandWeights& weights) {
    const std::vector<double> lights = lights_of(bands, illuminant, at_nanometres);
    MatrixColour unit;
    unit.nm = bands.centres_nm();
    unit.total.assign(unit.nm.size(), 0.0);
    for (std::size_t o = 0; o < unit.nm.size(); ++o) {
        unit.total[o] = 1.0;
        const double weight = r457(unit).value_or(0.0);
        unit.total[o] = 0.0;
        const auto row = static_cast<Eigen::Index>(o);
        weights.reflected(row, 3) = weight;
        weights.luminescent(row, 3) = lights[o] > 0.0 ? weight / lights[o] : 0.0;
    }
}

/// Reflectance of the emission bands for a diagonal entry of 1 in an excitation band, zero in the
/// others.
Vector reflectance_of_unit(ReradiationMatrix& zero, int row, int excitation) {
    zero.values(row, excitation) = 1.0;
    const Spectrum reflectance = zero.reflectance();
    zero.values(row, excitation) = 0.0;
    Vector at_bands(zero.emission.count);
    for (int o = 0; o < zero.emission.count; ++o)
        at_bands[o] = reflectance(zero.emission.centre_nm(o));
    return at_bands;
}

} // namespace

Matrix colour_gradient(const ReradiationMatrix& like, const Spectrum& illuminant, ColourSum sum,
                       bool at_nanometres, const ColourConditions& conditions, bool with_r457) {
    const BandSums sums(like.emission, like.excitation, Viewing(illuminant, conditions),
                        sum_range(like.emission, sum, at_nanometres));
    const double scale = 100.0 / sums.white()[1];
    const Eigen::Index columns = with_r457 ? 4 : 3;
    BandWeights weights{Matrix::Zero(like.emission.count, columns),
                        Matrix::Zero(like.emission.count, columns)};
    weights.reflected.leftCols(3) = scale * sums.reflected().transpose();
    weights.luminescent.leftCols(3) = scale * sums.luminescent().transpose();
    if (with_r457)
        add_r457(like.emission, illuminant, at_nanometres, weights);
    ReradiationMatrix zero = like;
    zero.values.setZero();
    Matrix gradient(like.values.size(), columns);
    for (Eigen::Index c = 0; c < columns; ++c)
        gradient.col(c) =
            Matrix(weights.luminescent.col(c) * sums.irradiance().transpose()).reshaped();
    for (int i = 0; i < like.excitation.count; ++i)
        if (const int row = diagonal_row(like, i); row >= 0)
            gradient.row(row + static_cast<Eigen::Index>(i) * like.emission.count) =
                reflectance_of_unit(zero, row, i).transpose() * weights.reflected;
    return gradient;
}

} // namespace reradiant
