#pragma once

#include "reradiant/colour_of_matrix.h"

#include <Eigen/Core>

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

/// The parts that a colour is summed from.
struct Exitance {
    Eigen::VectorXd reflectance, luminescent; ///< per emission band
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

/// XYZ of what is reflected, re-radiated, and reflected by the perfect diffuser, in one scale.
struct Sums {
    Xyz reflected{}, luminescent{}, white{};
};

/// What leaves the sample per emission band, for the light at the centres of the excitation bands
/// or for all of their nanometres.
Exitance exitance_of(const ReradiationMatrix& matrix, const Viewing& viewing, bool at_nanometres);

Sums sum_over_bands(const WavelengthGrid& bands, const Exitance& exitance, const Viewing& viewing);
/// Sums over 1 nm from 360 to 780 nm.
Sums sum_as_e308(const WavelengthGrid& bands, const Exitance& exitance, const Viewing& viewing);
/// Sums over 1 nm within the bands.
Sums sum_within_bands(const WavelengthGrid& bands, const Exitance& exitance,
                      const Viewing& viewing);
/// The standard carries the last values on, which it allows from 400 and to 700 nm.
bool reaches_far_enough(const WavelengthGrid& bands);

} // namespace reradiant
