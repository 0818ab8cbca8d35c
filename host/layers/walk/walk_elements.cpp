#include "host/layers/walk/walk_elements.h"

#include "host/layers/stack/stack_check.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <cmath>

namespace reradiant {

namespace {

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

WalkElement surface_element(WalkElement::Kind kind, const WalkSurface& surface) {
    WalkElement element;
    element.kind = kind;
    element.surface = surface;
    element.ior = surface.ior_above;
    return element;
}

void add_layer(WalkElements& elements, const StackValues& stack, std::size_t k) {
    const LayerValues& layer = stack[k];
    elements.push_back(surface_element(WalkElement::Kind::Surface, interface_surface(stack, k)));
    WalkElement& slab = elements.emplace_back();
    slab.kind = WalkElement::Kind::Slab;
    slab.ior = layer.ior;
    slab.tau = Eigen::ArrayXd::Constant(1, layer.tau);
    slab.tau_scattering = layer.tau_scattering;
    slab.anisotropy = layer.anisotropy;
    if (layer.flake_coverage > 0.0) {
        elements.push_back(
            surface_element(WalkElement::Kind::Flakes,
                            conductor_surface(layer.flakes, layer.ior, layer.wavelength_nm)));
        elements.back().coverage = layer.flake_coverage;
    }
}

WalkElements elements_at(const StackValues& stack, const SubstrateValues& substrate,
                         std::size_t band, double wavelength_nm) {
    check_stack(stack);
    WalkElements elements;
    for (std::size_t k = 0; k < stack.size(); ++k)
        add_layer(elements, stack, k);
    const double ior = stack.empty() ? 1.0 : stack.back().ior;
    if (!substrate.conductor.empty()) {
        check_conductor(substrate.conductor[band]);
        elements.push_back(
            surface_element(WalkElement::Kind::Conductor,
                            conductor_surface(substrate.conductor[band], ior, wavelength_nm)));
        return elements;
    }
    WalkElement& diffuse = elements.emplace_back();
    diffuse.kind = WalkElement::Kind::Diffuse;
    diffuse.ior = ior;
    diffuse.sigma = substrate.sigma;
    return elements;
}

/// Returns the values without those in which bands that share a walk may differ.
StackValues ways_of(StackValues stack) {
    for (LayerValues& layer : stack)
        layer.tau = 0.0;
    return stack;
}

} // namespace

WalkMaterial::WalkMaterial(const LayerStack& stack, const SubstrateValues& substrate,
                           const std::vector<double>& wavelengths_nm)
    : matrix_(checked_matrix(substrate, wavelengths_nm.size())) {
    fluorescent_ = !matrix_.isDiagonal(0.0);
    std::vector<StackValues> values;
    bool same = true;
    for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
        values.push_back(stack_at(stack, wavelengths_nm[band]));
        by_band_.push_back(elements_at(values[band], substrate, band, wavelengths_nm[band]));
        same =
            same && ways_of(values[band]) == ways_of(values[0]) &&
            (substrate.conductor.empty() || (substrate.conductor[band] == substrate.conductor[0] &&
                                             substrate.conductor[0].film.thickness_nm == 0.0));
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
