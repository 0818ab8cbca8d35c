#include "host/layers/walk/guided_light.h"

#include "kernels/scatter/fresnel.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

using Kind = WalkElement::Kind;

namespace {

/// Returns the reflectance of a face that a ray leaves a slab by, or nothing where that is no
/// smooth interface.
std::optional<double> smooth_reflectance(const WalkElement& face, bool from_below, double cosine) {
    if (face.kind != Kind::Surface || face.surface.is_rough())
        return std::nullopt;
    return face.surface.reflectance(from_below, cosine);
}

} // namespace

GuidedLight::GuidedLight(const WalkElements& elements, std::size_t element, const kernels::Vec3& d)
    : elements_(elements), d_(d) {
    const WalkElement& slab = elements[element];
    const double cosine = std::clamp(std::fabs(d.z), 1e-300, 1.0);
    passages_.push_back({element, slab.ior, cosine, (slab.tau(0) + slab.tau_scattering) / cosine});
}

GuidedLight::Passage GuidedLight::passage(std::size_t element) const {
    const WalkElement& slab = elements_[element];
    const double cosine =
        std::max(kernels::fresnel_cos_transmitted(std::min(std::fabs(d_.z), 1.0),
                                                  slab.ior / passages_[here_].ior),
                 1e-300);
    return {element, slab.ior, cosine, (slab.tau(0) + slab.tau_scattering) / cosine};
}

std::optional<GuidedLight> GuidedLight::find(const WalkElements& elements, std::size_t element,
                                             const kernels::Vec3& d) {
    GuidedLight light(elements, element, d);
    if (light.close_upwards() && light.close_downwards())
        return light;
    return std::nullopt;
}

/// Adds the slabs beneath as far as light gets; false where something lets it go.
bool GuidedLight::close_downwards() {
    while (true) {
        Passage& lowest = passages_.back();
        const std::size_t face = lowest.element + 1;
        const auto r = smooth_reflectance(elements_[face], false, lowest.cosine);
        if (!r || *r >= 1.0)
            return r.has_value();
        lowest.reflected_beneath = *r;
        if (face + 1 == elements_.size() || elements_[face + 1].kind != Kind::Slab)
            return false;
        passages_.push_back(passage(face + 1));
    }
}

/// The same above.
bool GuidedLight::close_upwards() {
    while (true) {
        const std::size_t face = passages_.front().element - 1;
        const auto r = smooth_reflectance(elements_[face], true, passages_.front().cosine);
        if (!r || *r >= 1.0)
            return r.has_value();
        if (face == 0 || elements_[face - 1].kind != Kind::Slab)
            return false;
        Passage above = passage(face - 1);
        above.reflected_beneath = *r;
        passages_.insert(passages_.begin(), above);
        ++here_;
    }
}

bool GuidedLight::is_clear() const {
    return std::ranges::all_of(passages_, [](const Passage& p) { return p.depth == 0.0; });
}

/// Entry (from, to): the chance that light which enters a passage comes through and then into
/// another. An interface reflects the same share from both sides.
Eigen::MatrixXd GuidedLight::transitions() const {
    const auto count = static_cast<Eigen::Index>(passages_.size());
    Eigen::MatrixXd to = Eigen::MatrixXd::Zero(2 * count, 2 * count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const Passage& own = passages_[static_cast<std::size_t>(k)];
        const double through = std::exp(-own.depth);
        const double above =
            k > 0 ? passages_[static_cast<std::size_t>(k - 1)].reflected_beneath : 1.0;
        to(k, count + k) = through * own.reflected_beneath;
        to(count + k, k) = through * above;
        if (k + 1 < count)
            to(k, k + 1) = through * (1.0 - own.reflected_beneath);
        if (k > 0)
            to(count + k, count + k - 1) = through * (1.0 - above);
    }
    return to;
}

/// The chances by passage that light which enters one has its next event there. All other states
/// are eliminated from the chain without a subtraction (Grassmann, Taksar and Heyman 1985), so that
/// the digits hold however seldom an event comes; the chances are left unnormalised.
Eigen::VectorXd GuidedLight::chances_of_events(std::size_t state) const {
    Eigen::MatrixXd to = transitions();
    const Eigen::Index states = to.rows(), kept = static_cast<Eigen::Index>(state);
    Eigen::MatrixXd ends = Eigen::MatrixXd::Zero(states, states);
    for (Eigen::Index s = 0; s < states; ++s)
        ends(s, s) = -std::expm1(-passages_[static_cast<std::size_t>(s) % passages_.size()].depth);
    for (Eigen::Index s = 0; s < states; ++s) {
        if (s == kept)
            continue;
        to(s, s) = 0.0; // it leaves in the end, whatever comes back to it meanwhile
        const double leaves = to.row(s).sum() + ends.row(s).sum();
        for (Eigen::Index from = 0; from < states; ++from) {
            const double share = to(from, s) / leaves;
            to.row(from) += share * to.row(s);
            ends.row(from) += share * ends.row(s);
            to(from, s) = 0.0;
        }
    }
    return ends.row(kept);
}

std::size_t GuidedLight::state_after_face(WalkRandom& random) const {
    const std::size_t count = passages_.size();
    const bool down = d_.z < 0.0;
    double reflected = 1.0;
    if (down || here_ > 0)
        reflected = passages_[down ? here_ : here_ - 1].reflected_beneath;
    if (random.next() < reflected)
        return down ? count + here_ : here_;
    return down ? here_ + 1 : count + here_ - 1;
}

std::optional<GuidedLight::Event> GuidedLight::next_event(WalkRandom& random) const {
    if (is_clear())
        return std::nullopt;
    const Eigen::VectorXd chances = chances_of_events(state_after_face(random));
    std::size_t state = 0;
    double rest = random.next() * chances.sum();
    for (Eigen::Index s = 0; s < chances.size() && rest >= 0.0; ++s) {
        if (chances(s) > 0.0) {
            state = static_cast<std::size_t>(s);
            rest -= chances(s);
        }
    }
    const bool down = state < passages_.size();
    const Passage& own = passages_[state % passages_.size()];
    const double free_depth = -std::log1p(random.next() * std::expm1(-own.depth));
    const double share = std::min(free_depth / own.depth, 1.0);
    const double across = passages_[here_].ior / own.ior;
    return Event{own.element,
                 kernels::vec3(d_.x * across, d_.y * across, down ? -own.cosine : own.cosine),
                 down ? share : 1.0 - share};
}

} // namespace reradiant
