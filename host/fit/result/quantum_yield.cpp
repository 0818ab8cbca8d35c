#include "host/fit/result/quantum_yield.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace reradiant {

namespace {

constexpr double normal_95 = 1.959963984540054;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_absorptance_error = 0.1;

std::vector<Eigen::Index> telling_bands(const Eigen::MatrixXd& share, Eigen::Index term) {
    const double best = share.col(term).maxCoeff();
    std::vector<Eigen::Index> strong, dominated;
    for (Eigen::Index i = 0; best > 0.0 && i < share.rows(); ++i) {
        if (share(i, term) < 0.5 * best)
            continue;
        strong.push_back(i);
        if (share(i, term) >= share.row(i).maxCoeff())
            dominated.push_back(i);
    }
    return dominated.empty() ? strong : dominated;
}

} // namespace

std::vector<QuantumYield> quantum_yields(const EmittedPhotons& emitted,
                                         const Eigen::VectorXd& diagonal,
                                         const Eigen::VectorXd& diagonal_sigma,
                                         std::vector<std::string>& warnings) {
    std::vector<QuantumYield> yields;
    for (Eigen::Index k = 0; k < emitted.share.cols(); ++k) {
        const std::vector<Eigen::Index> bands = telling_bands(emitted.share, k);
        double photons = 0.0, absorbed = 0.0, variance = 0.0;
        for (const Eigen::Index i : bands) {
            const bool known = std::isfinite(diagonal(i));
            const double mine = emitted.share(i, k) / emitted.share.row(i).sum();
            photons += emitted.share(i, k);
            absorbed += mine * (known ? 1.0 - diagonal(i) : 1.0);
            variance += known ? std::pow(mine * diagonal_sigma(i), 2) : 0.0;
        }
        if (!(photons > 0.0)) {
            yields.push_back({0.0, 0.0, 1.0});
            continue;
        }
        if (!(absorbed > normal_95 * std::sqrt(variance))) {
            warnings.push_back(fmt::format("quantum yield {} is unknown: the absorptance where the "
                                           "term emits is lost in its error",
                                           k + 1));
            yields.push_back({unknown, unknown, unknown});
            continue;
        }
        const double absorptance_error = std::sqrt(variance) / absorbed;
        if (absorptance_error > largest_absorptance_error)
            warnings.push_back(fmt::format("the absorptance behind quantum yield {} is uncertain "
                                           "by {:.0f} %; beyond 10 % a yield may be far too low",
                                           k + 1, 100.0 * absorptance_error));
        const double value = photons / absorbed;
        const double half = normal_95 * value *
                            std::hypot(emitted.sigma_of_sum(k, bands) / photons, absorptance_error);
        yields.push_back({value, std::max(0.0, value - half), value + half});
    }
    return yields;
}

} // namespace reradiant
