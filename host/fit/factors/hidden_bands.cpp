#include "host/fit/factors/hidden_bands.h"

#include "host/fit/models/photon_penalty.h"

#include <algorithm>
#include <vector>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double told_share = 0.01, known_share = 0.001;
/// Rise of the chi squared by a filled band: three standard errors.
constexpr double largest_objection = 9.0;

/// `BandKnowledge` says which bands of a curve the used entries tell about.
struct BandKnowledge {
    std::vector<bool> hidden; ///< next to nothing
    std::vector<bool> known;  ///< enough to go on from: 0.1 % of what they tell about the best band
};

BandKnowledge knowledge_of(const Matrix& used, const Matrix& allowed, const Vector& other) {
    const Vector energy = other.cwiseAbs2();
    const Vector seen = used * energy, all = allowed * energy;
    BandKnowledge knowledge;
    for (Eigen::Index band = 0; band < seen.size(); ++band) {
        const bool hidden = seen(band) < told_share * all(band);
        knowledge.hidden.push_back(hidden);
        knowledge.known.push_back(!hidden && seen(band) >= known_share * seen.maxCoeff());
    }
    return knowledge;
}

/// The next known band, going by `step`; -1: there is none.
Eigen::Index known_beside(const std::vector<bool>& known, Eigen::Index band, Eigen::Index step) {
    const auto count = static_cast<Eigen::Index>(known.size());
    do
        band += step;
    while (band >= 0 && band < count && !known[static_cast<std::size_t>(band)]);
    return band >= 0 && band < count ? band : -1;
}

/// A curve beyond its last known band, at the end that `step` points away from.
double continued(const Vector& curve, const std::vector<bool>& known, Eigen::Index band,
                 Eigen::Index last, Eigen::Index step) {
    const Eigen::Index before = known_beside(known, last, step);
    if (before < 0)
        return curve(last);
    const double slope = (curve(last) - curve(before)) / static_cast<double>(last - before);
    return std::clamp(curve(last) + slope * static_cast<double>(band - last), 0.0, curve(last));
}

double filled(const Vector& curve, const std::vector<bool>& known, Eigen::Index band) {
    const Eigen::Index left = known_beside(known, band, -1);
    const Eigen::Index right = known_beside(known, band, 1);
    if (left >= 0 && right >= 0) {
        const double share = static_cast<double>(band - left) / static_cast<double>(right - left);
        return (1.0 - share) * curve(left) + share * curve(right);
    }
    if (left < 0 && right < 0)
        return curve(band);
    return left >= 0 ? continued(curve, known, band, left, -1)
                     : continued(curve, known, band, right, 1);
}

/// Returns the misfit of the curves to the data and to the diagonal.
double misfit(const FitTarget& target, const FactorCurves& curves) {
    const Matrix matrix =
        (curves.emission * curves.excitation.transpose()).cwiseProduct(target.allowed);
    return target.chi_squared(matrix) + PhotonPenalty(target).misfit(target.photon_sums(matrix));
}

/// Fills the hidden bands of one curve of `curves` as far as the data do not object.
void fill(const FitTarget& target, const BandKnowledge& knowledge, FactorCurves& curves,
          Eigen::Ref<Vector> curve) {
    const Vector fitted = curve;
    double before = misfit(target, curves);
    for (Eigen::Index band = 0; band < fitted.size(); ++band) {
        if (!knowledge.hidden[static_cast<std::size_t>(band)])
            continue;
        curve(band) = filled(fitted, knowledge.known, band);
        const double after = misfit(target, curves);
        if (after > before + largest_objection)
            curve(band) = fitted(band);
        else
            before = after;
    }
}

} // namespace

void bridge_hidden_bands(const FitTarget& target, FactorCurves& curves) {
    const Matrix used = (target.weight.array() > 0.0).cast<double>();
    const FactorCurves fitted = curves;
    for (Eigen::Index k = 0; k < fitted.emission.cols(); ++k) {
        fill(target, knowledge_of(used, target.allowed, fitted.excitation.col(k)), curves,
             curves.emission.col(k));
        fill(target,
             knowledge_of(used.transpose(), target.allowed.transpose(), fitted.emission.col(k)),
             curves, curves.excitation.col(k));
    }
    const Vector sums = target.photon_sums(
        (curves.emission * curves.excitation.transpose()).cwiseProduct(target.allowed));
    for (Eigen::Index i = 0; i < sums.size(); ++i)
        if (sums(i) > target.budget(i))
            curves.excitation.row(i) *= target.budget(i) / sums(i);
}

} // namespace reradiant
