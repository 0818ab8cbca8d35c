#pragma once

#include "reradiant/colour_of_matrix.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Range of the weights of ASTM E308.
inline constexpr int e308_from_nm = 360, e308_to_nm = 780;

/// Colour matching functions by wavelength; zero outside their table.
class Eye {
public:
    explicit Eye(Observer observer);
    Xyz operator()(double nm) const;

private:
    const std::vector<double>& nodes_;
    std::array<Spectrum, 3> curves_;
};

/// sum += factor * term.
void add(Xyz& sum, const Xyz& term, double factor);

/// A lamp's light around a wavelength, per nm. Tables in steps of 1 nm or more count with their
/// value there, as the standards have it. What is finer counts with its mean over the nanometre.
class LampAtNanometres {
public:
    /// The lamp must outlive this.
    explicit LampAtNanometres(const Spectrum& lamp);
    double operator()(double nm) const;

private:
    const Spectrum& lamp_;
    Spectrum smooth_;
    bool is_fine_;
};

/// What leaves a sample per emission band.
struct Exitance {
    Eigen::VectorXd reflectance, luminescent;
};

/// All that the sums depend on beside the matrix.
struct Viewing {
    Viewing(const Spectrum& illuminant, const ColourConditions& conditions)
        : eye(conditions.observer), lamp(illuminant),
          weights(conditions.weighted_by ? *conditions.weighted_by : illuminant),
          is_reweighted(conditions.weighted_by.has_value()),
          excites_from_nm(conditions.excites_from_nm) {}

    /// Re-radiated light counts as the radiance factor that it makes under the lamp, times the
    /// weight.
    double luminescent_weight(double lamp_light, double weight) const {
        if (!is_reweighted)
            return 1.0;
        return lamp_light > 0.0 ? weight / lamp_light : 0.0;
    }

    Eye eye;
    const Spectrum& lamp;
    const Spectrum& weights;
    bool is_reweighted;
    double excites_from_nm;
};

/// Mean irradiance of every excitation band, as it counts in the sum: at its centre, or over all of
/// its nanometres.
Eigen::VectorXd irradiance_of(const WavelengthGrid& bands, const Viewing& viewing,
                              bool at_nanometres);
/// Light of every emission band, as its radiance factor is divided by it: at its centre, or its
/// mean.
std::vector<double> lights_of(const WavelengthGrid& bands, const Spectrum& illuminant,
                              bool at_nanometres);

/// XYZ of what is reflected, re-radiated, and reflected by the perfect diffuser, in one scale.
struct Sums {
    Xyz reflected{}, luminescent{}, white{};
};

/// The wavelengths that a colour is summed over.
enum class SumRange {
    Bands,       ///< centres of the bands
    WithinBands, ///< every nanometre within the bands
    E308,        ///< every nanometre from 360 to 780 nm
};

/// The range that ColourSum stands for, where it is decided whether nanometres are summed.
SumRange sum_range(const WavelengthGrid& bands, ColourSum sum, bool at_nanometres);

/// The sums of a colour as they depend on the lamp, the observer and the grids: linear in the
/// matrix, so that many matrices on the same grids share them.
class BandSums {
public:
    BandSums(const WavelengthGrid& emission, const WavelengthGrid& excitation,
             const Viewing& viewing, SumRange range);

    /// What leaves a matrix on these grids. Light counts at the centres of the excitation bands, or
    /// in all of their nanometres where the sum is over nanometres.
    Exitance exitance_of(const ReradiationMatrix& matrix) const;
    Sums sums_of(const Exitance& exitance) const;

    const Eigen::VectorXd& irradiance() const { return irradiance_; }
    /// What reflectance and re-radiated light count by, (XYZ, emission bands).
    const Eigen::Matrix3Xd& reflected() const { return reflected_; }
    const Eigen::Matrix3Xd& luminescent() const { return luminescent_; }
    const Xyz& white() const { return white_; }

private:
    void add_bands(const WavelengthGrid& bands, const Viewing& viewing);
    void add_nanometres(const WavelengthGrid& bands, const Viewing& viewing, double from_nm,
                        double to_nm);

    Eigen::VectorXd irradiance_;
    Eigen::Matrix3Xd reflected_, luminescent_;
    Xyz white_{};
};

/// The standard carries the last values on, which it allows from 400 and to 700 nm.
bool reaches_far_enough(const WavelengthGrid& bands);

} // namespace reradiant
