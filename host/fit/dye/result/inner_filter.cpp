#include "host/fit/dye/result/inner_filter.h"

#include "host/layers/smooth/smooth_stack.h"

#include <cmath>

namespace reradiant {

namespace {

/// Cosine within a medium, and what the interface to it lets through.
struct Refracted {
    double cosine, transmittance;

    Refracted(double cosine_in_air, double ior) {
        const double g2_air = cosine_in_air * cosine_in_air;
        const double g2 = (ior - 1.0) * (ior + 1.0) + g2_air;
        cosine = std::sqrt(std::max(g2, 0.0)) / ior;
        transmittance = fresnel_pair(1.0, ior, g2_air, g2).transmittance;
    }
};

} // namespace

std::optional<InnerFilter> inner_filter(const LayerStack& stack, const DyeView& view,
                                        const Eigen::VectorXd& depth, const DyeProblem& problem) {
    if (!view.cosine || view.from.side != Side::Above || view.seen != Side::Above ||
        stack.layers.size() != 1)
        return std::nullopt;
    const WavelengthGrid& bands = problem.bands;
    InnerFilter filter{Eigen::MatrixXd::Zero(problem.emission.count, problem.excitation.count)};
    for (Eigen::Index i = 0; i < problem.excitation.count; ++i)
        for (Eigen::Index o = 0; o < problem.emission.count; ++o) {
            const Eigen::Index in = problem.excitation.first + i, out = problem.emission.first + o;
            if (out <= in)
                continue;
            const double n_in = stack.layers[0].ior(bands.centre_nm(static_cast<int>(in)));
            const double n_out = stack.layers[0].ior(bands.centre_nm(static_cast<int>(out)));
            const Refracted down(view.from.cosine, n_in), up(*view.cosine, n_out);
            const double absorbed = depth(in) / down.cosine;
            const double both = absorbed + depth(out) / up.cosine;
            const double kept = both > 0.0 ? -std::expm1(-both) / both : 1.0;
            filter.factor(o, i) = down.transmittance * up.transmittance / (4.0 * n_out * n_out) *
                                  absorbed / up.cosine * kept;
        }
    return filter;
}

CorrectedDye corrected_dye(const InnerFilter& filter, const DyeBlock& block,
                           const DyeProblem& problem) {
    const WavelengthGrid& bands = problem.bands;
    Eigen::VectorXd sent = Eigen::VectorXd::Zero(problem.emission.count);
    for (Eigen::Index o = 0; o < problem.emission.count; ++o) {
        double pull = 0.0, weight = 0.0;
        for (Eigen::Index i = 0; i < problem.excitation.count; ++i) {
            const double lo = bands.centre_nm(static_cast<int>(problem.emission.first + o));
            const double li = bands.centre_nm(static_cast<int>(problem.excitation.first + i));
            // of power sent out in lo and li, photons of lo per photon of li
            const double factor = filter.factor(o, i) * li / lo * block.weight(o, i);
            pull += factor * block.value(o, i) * block.weight(o, i);
            weight += factor * factor;
        }
        sent(o) = weight > 0.0 ? std::max(0.0, pull / weight) : 0.0;
    }
    CorrectedDye dye{sent.sum(), sent};
    for (Eigen::Index o = 0; o < sent.size(); ++o) // photons to power
        dye.emission(o) /= bands.centre_nm(static_cast<int>(problem.emission.first + o));
    dye.emission /= std::max(dye.emission.sum(), 1e-300);
    return dye;
}

} // namespace reradiant
