#include "host/fit/dye/emission_shares.h"

#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Index = Eigen::Index;
using Row = Eigen::RowVectorXd;

/// Nodes within the band that absorbs.
constexpr int nodes = 8;
/// Share of an emission's photons that is none: where no more lies above, less than the yield is
/// sent out. Without this the last band of a tail would take all light, however dark it is.
constexpr double nothing = 1e-3;

/// Rise of an emission over a band: half that between its neighbours, bent smoothly so that it
/// stays within twice the mean, which keeps the emission from falling below zero in the band.
struct Rise {
    double value = 0.0, by_mean = 0.0, by_rise = 0.0;

    Rise(double mean, double rise) {
        if (rise == 0.0)
            return;
        const double r = 2.0 * std::max(mean, 0.0) / std::fabs(rise), r4 = r * r * r * r;
        const double sign = rise > 0.0 ? 1.0 : -1.0;
        if (r > 1e3) {
            value = rise;
            by_rise = 1.0;
            return;
        }
        value = 2.0 * mean * sign / std::sqrt(std::sqrt(1.0 + r4));
        by_mean = 2.0 * sign / std::pow(1.0 + r4, 1.25);
        by_rise = r * r4 / std::pow(1.0 + r4, 1.25);
    }
};

/// An emission in one band: its mean and rise, and their derivatives by the emission of all bands.
struct BandEmission {
    double mean, rise;
    Row by_mean, by_rise;

    BandEmission(const Eigen::VectorXd& emission, Index band)
        : mean(emission(band)), rise(0.0), by_mean(Row::Zero(emission.size())), by_rise(by_mean) {
        const Index last = emission.size() - 1;
        const double before = band > 0 ? emission(band - 1) : 0.0;
        const double after = band < last ? emission(band + 1) : 0.0;
        const Rise bent(mean, 0.5 * (after - before));
        rise = bent.value;
        by_mean(band) = 1.0;
        by_rise(band) = bent.by_mean;
        if (band > 0)
            by_rise(band - 1) = -0.5 * bent.by_rise;
        if (band < last)
            by_rise(band + 1) = 0.5 * bent.by_rise;
    }
};

} // namespace

EmissionShares::EmissionShares(const Eigen::VectorXd& emission, const WavelengthGrid& bands)
    : emission_(emission), above_(Eigen::VectorXd::Zero(bands.count)), within_(above_),
      above_by_emission_(Eigen::MatrixXd::Zero(bands.count, bands.count)),
      within_by_emission_(above_by_emission_) {
    double photons = 0.0, least = 0.0; // of the bands above, and what counts as none
    Row photons_by = Row::Zero(bands.count), least_by = photons_by;
    for (int k = 0; k < bands.count; ++k) {
        least += nothing * emission(k) * bands.centre_nm(k);
        least_by(k) = nothing * bands.centre_nm(k);
    }
    const Quadrature& rule = gauss_legendre(nodes);
    for (int k = bands.count - 1; k >= 0; --k) {
        const BandEmission own(emission, k);
        const double nm = bands.centre_nm(k), step = bands.step_nm;
        for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
            const double s = rule.nodes[j] - 0.5, li = nm + step * s;
            // means above s of 1, of the rise's shape, and of both times the wavelength
            const double one = 0.5 - s, bent = 0.125 - 0.5 * s * s;
            const double third = (0.125 - s * s * s) / 3.0;
            const double flat = nm * one + step * bent, steep = nm * bent + step * third;
            const double above = photons + own.mean * flat + own.rise * steep;
            const double left = std::hypot(above, least);
            const Row left_by =
                (above / left) * (photons_by + flat * own.by_mean + steep * own.by_rise) +
                (least / left) * least_by;
            const double sent = own.mean * one + own.rise * bent, w = rule.weights[j] * li / left;
            above_(k) += w;
            within_(k) += w * sent;
            above_by_emission_.row(k) -= (w / left) * left_by;
            within_by_emission_.row(k) +=
                w * (one * own.by_mean + bent * own.by_rise - (sent / left) * left_by);
        }
        photons += own.mean * nm + own.rise * step / 12.0;
        photons_by += nm * own.by_mean + (step / 12.0) * own.by_rise;
    }
}

Eigen::MatrixXd EmissionShares::matrix() const {
    const Index n = emission_.size();
    Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(n, n);
    for (Index k = 0; k < n; ++k) {
        shares(k, k) = within_(k);
        shares.col(k).tail(n - 1 - k) = above_(k) * emission_.tail(n - 1 - k);
    }
    return shares;
}

} // namespace reradiant
