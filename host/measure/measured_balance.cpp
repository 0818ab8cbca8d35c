#include "reradiant/measure.h"

#include <Eigen/Core>

namespace reradiant {

namespace {

/// Sums over what leaves, by band of excitation.
struct Sums {
    double theta_i_deg;
    Eigen::ArrayXd energy, photons;

    MeasuredBalance balance() const {
        return {theta_i_deg, energy.minCoeff(), energy.maxCoeff(), photons.minCoeff(),
                photons.maxCoeff()};
    }
};

} // namespace

std::vector<MeasuredBalance> measured_balances(const Measurement& measurement) {
    std::vector<MeasuredBalance> balances;
    if (!measurement.hemispherical)
        return balances;
    std::vector<Sums> sums;
    for (const MeasureRow& row : measurement.rows) {
        if (sums.empty() || sums.back().theta_i_deg != row.theta_i_deg) {
            const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(measurement.bands.count);
            sums.push_back({row.theta_i_deg, none, none});
        }
        const int band = measurement.bands.band_of(row.lambda_i_nm);
        sums.back().energy(band) += row.value;
        sums.back().photons(band) += row.value * row.lambda_o_nm / row.lambda_i_nm;
    }
    for (const Sums& one : sums)
        balances.push_back(one.balance());
    return balances;
}

} // namespace reradiant
