#include "host/layers/walk/walk_elements.h"

#include "host/layers/stack/stack_check.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>

namespace reradiant {

namespace {

using Kind = WalkElement::Kind;

/// The matrix as light feels it, or with nothing in it for a conductor.
Eigen::MatrixXd checked_matrix(const SubstrateValues& substrate, std::size_t bands) {
    const auto n = static_cast<Eigen::Index>(bands);
    if (!substrate.conductor.empty())
        return Eigen::MatrixXd::Zero(n, n);
    if (substrate.matrix.rows() != n || substrate.matrix.cols() != n) {
        throw_input_error({},
                          fmt::format("a matrix of {} x {} for {} bands", substrate.matrix.rows(),
                                      substrate.matrix.cols(), bands),
                          "give it a row and a column for each band");
    }
    if (!(substrate.matrix.array() >= 0.0).all()) {
        throw_input_error({}, "the re-radiation matrix has a negative entry",
                          "a walk follows light, of which there is no less than none");
    }
    return substrate.matrix;
}

/// Returns what the walk needs of an element.
struct WalkElementOf {
    WalkElement operator()(const SurfaceValues& surface) const {
        const Kind kind = surface.is_conductor ? Kind::Conductor : Kind::Surface;
        return {.kind = kind, .surface = walk_surface(surface), .ior = surface.ior_above};
    }
    WalkElement operator()(const SlabValues& slab) const {
        return {.kind = Kind::Slab,
                .ior = slab.ior,
                .tau = Eigen::ArrayXd::Constant(1, slab.tau),
                .tau_scattering = slab.tau_scattering,
                .anisotropy = slab.anisotropy};
    }
    WalkElement operator()(const FlakesValues& flakes) const {
        return {.kind = Kind::Flakes,
                .surface = walk_surface(flakes.reflector),
                .ior = flakes.reflector.ior_above,
                .coverage = flakes.coverage};
    }
    WalkElement operator()(const DiffuseValues& substrate) const {
        return {.kind = Kind::Diffuse, .ior = substrate.ior_above, .sigma = substrate.sigma};
    }
};

WalkElements walk_elements(const StackElements& stack) {
    check_stack(stack);
    WalkElements elements;
    for (const StackElement& element : stack)
        elements.push_back(std::visit(WalkElementOf{}, element));
    return elements;
}

/// Returns the stack without the numbers in which bands that share a walk may differ.
StackElements ways_of(StackElements stack) {
    for (StackElement& element : stack)
        if (auto* slab = std::get_if<SlabValues>(&element))
            slab->tau = 0.0;
    return stack;
}

} // namespace

WalkMaterial::WalkMaterial(const LayerStack& stack, const SubstrateValues& substrate,
                           const std::vector<double>& wavelengths_nm)
    : matrix_(checked_matrix(substrate, wavelengths_nm.size())) {
    fluorescent_ = !matrix_.isDiagonal(0.0);
    std::vector<StackElements> ways;
    bool same = true;
    for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
        const StackElements values =
            stack_over(stack_at(stack, wavelengths_nm[band]), substrate.at_band(band));
        by_band_.push_back(walk_elements(values));
        const SurfaceValues* conductor = conductor_of(values);
        ways.push_back(ways_of(values));
        same = same && ways.back() == ways.front() && !(conductor && conductor->has_film());
    }
    if (!same)
        return;
    shared_ = by_band_[0];
    for (std::size_t e = 0; e < shared_.size(); ++e) {
        if (shared_[e].kind == WalkElement::Kind::Slab) {
            shared_[e].tau.resize(bands());
            for (int band = 0; band < bands(); ++band)
                shared_[e].tau(band) = at_band(band)[e].tau(0);
        }
    }
}

WalkMaterial::WalkMaterial(const StackElements& stack)
    : shared_(walk_elements(stack_over(stack, DiffuseValues{}))), by_band_{shared_},
      matrix_(Eigen::MatrixXd::Ones(1, 1)) {}

WalkMaterial WalkMaterial::reversed() const {
    WalkMaterial result = *this;
    for (int to = 0; to < bands(); ++to) {
        for (int from = 0; from < bands(); ++from) {
            const double ratio = at_band(to).back().ior / at_band(from).back().ior;
            result.matrix_(to, from) = matrix_(from, to) * ratio * ratio;
        }
    }
    return result;
}

} // namespace reradiant
