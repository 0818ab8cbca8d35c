#include "host/layers/walk/walk_elements.h"

#include "host/layers/stack/stack_check.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

using Kind = WalkElement::Kind;

/// The matrix as light feels it, or with nothing in it for a conductor and for a sheet.
Eigen::MatrixXd checked_matrix(const SubstrateValues& substrate, bool is_sheet, std::size_t bands) {
    const auto n = static_cast<Eigen::Index>(bands);
    if (is_sheet || !substrate.conductor.empty())
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
            slab->tau = slab->tau_dyes = 0.0;
    return stack;
}

/// Puts what the dyes send out of light of a band into its slabs, which stand in the order of the
/// layers.
void add_emission(WalkElements& elements, const std::vector<double>& tau_dyes, int band,
                  const std::vector<Eigen::MatrixXd>& emissions) {
    std::size_t layer = 0;
    for (WalkElement& element : elements) {
        if (element.kind != Kind::Slab)
            continue;
        if (emissions[layer].size() > 0) {
            element.tau_dyes = element.tau_emission = tau_dyes[layer];
            element.emission = emissions[layer].col(band);
        }
        ++layer;
    }
}

std::vector<double> depths_of_dyes(const StackElements& stack) {
    std::vector<double> depths;
    for (const StackElement& element : stack)
        if (const auto* slab = std::get_if<SlabValues>(&element))
            depths.push_back(slab->tau_dyes);
    return depths;
}

} // namespace

WalkMaterial::WalkMaterial(const LayerStack& stack, const SubstrateValues& substrate,
                           const std::vector<double>& wavelengths_nm,
                           const std::vector<Eigen::MatrixXd>& emissions)
    : matrix_(checked_matrix(substrate, stack.is_sheet(), wavelengths_nm.size())),
      is_dyed_(stack.is_dyed()), is_sheet_(stack.is_sheet()) {
    if (is_dyed_ && emissions.size() != stack.layers.size())
        throw std::invalid_argument("a walk through dyes needs to know what they send out");
    fluorescent_ = !is_sheet_ && (is_dyed_ || !matrix_.isDiagonal(0.0));
    std::vector<StackElements> values;
    for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
        const StackElements own = stack_at(stack, wavelengths_nm[band]);
        values.push_back(is_sheet_ ? own : stack_over(own, substrate.at_band(band)));
        by_band_.push_back(walk_elements(values.back()));
        if (is_dyed_)
            add_emission(by_band_.back(), depths_of_dyes(own), static_cast<int>(band), emissions);
    }
    if (!is_dyed_)
        share_elements(values);
}

void WalkMaterial::share_elements(const std::vector<StackElements>& values) {
    for (const StackElements& at_band : values) {
        const SurfaceValues* conductor = conductor_of(at_band);
        if (ways_of(at_band) != ways_of(values.front()) || (conductor && conductor->has_film()))
            return;
    }
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
            const auto ratio2 = [&](std::size_t e) {
                return kernels::square(at_band(to)[e].ior / at_band(from)[e].ior);
            };
            const std::size_t last = at_band(to).size() - 1;
            result.matrix_(to, from) = matrix_(from, to) * ratio2(last);
            for (std::size_t e = 0; e < last; ++e)
                if (at_band(to)[e].is_dyed())
                    result.by_band_[static_cast<std::size_t>(from)][e].emission(to) =
                        at_band(to)[e].emission(from) * ratio2(e);
        }
    }
    // backwards, dyes take up light of bands in which they do not absorb
    for (WalkElements& elements : result.by_band_)
        for (WalkElement& element : elements)
            if (element.is_dyed())
                element.tau_emission = std::max(element.tau_emission, element.emission.sum());
    return result;
}

} // namespace reradiant
