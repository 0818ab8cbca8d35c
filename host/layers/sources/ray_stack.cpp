#include "host/layers/sources/ray_stack.h"

#include "host/layers/smooth/smooth_stack.h"

#include <cmath>

namespace reradiant {

namespace {

/// (y + expm1(-y)) / y^2 for y >= 0: half at 0.
double second_moment(double y) {
    if (y < 1e-2)
        return 0.5 - y * (1.0 / 6.0 - y * (1.0 / 24.0 - y * (1.0 / 120.0 - y / 720.0)));
    return (y + std::expm1(-y)) / (y * y);
}

void append(Eigen::VectorXd& vector, double value) {
    vector.conservativeResize(vector.size() + 1);
    vector(vector.size() - 1) = value;
}

/// One thing that light meets: as RayResponse, the same from both sides.
struct RayPart {
    double transmission = 1.0, back = 0.0, absorbed = 0.0;
    bool is_source = false;
    double fluence = 0.0; ///< of a source: mean in the cell per flux
};

} // namespace

/// The pile as far as it was put together from above, one part after the other.
class RayStack::Fold {
public:
    Fold(Eigen::Index sources, double weight, RayExchange* exchange)
        : weight_(weight), exchange_(exchange) {
        whole_.from_above.setZero(sources);
        whole_.from_below.setZero(sources);
    }

    /// Adds a part beneath. `self` is what a source does to itself.
    void add(const RayPart& part, double self) {
        RayResponse& a = whole_;
        const double kept = (a.transmission + a.absorbed_below) +
                            a.back_below * (part.transmission + part.absorbed);
        const double inverse = kept > 0.0 ? 1.0 / kept : 0.0;
        if (exchange_)
            exchange(part, self, inverse, kept > 0.0);
        const double up = part.back * inverse, down = a.back_below * inverse;
        auto above = a.from_above.head(count_);
        auto below = a.from_below.head(count_);
        above += below * (a.transmission * up);
        below *= part.transmission * inverse;
        if (part.is_source) {
            a.from_above(count_) = part.fluence * a.transmission * inverse;
            a.from_below(count_) = part.fluence * (1.0 + part.transmission * down);
            ++count_;
        }
        a.absorbed_below = part.absorbed + part.transmission * inverse *
                                               (a.back_below * part.absorbed + a.absorbed_below);
        a.back_above += a.transmission * a.transmission * up;
        a.back_below = part.back + part.transmission * part.transmission * down;
        a.transmission *= part.transmission * inverse;
    }

    /// Adds the substrate, which takes all that reaches it; nothing does where the path above it
    /// is evanescent.
    void add_substrate(bool is_reached) {
        if (!is_reached) {
            ++count_;
            return;
        }
        if (exchange_) {
            auto row = exchange_->between.row(count_);
            row.head(count_) += weight_ * whole_.from_below.head(count_).transpose();
            exchange_->between.col(count_).head(count_) += weight_ * whole_.from_below.head(count_);
            row(count_) += weight_ * whole_.back_below;
        }
        whole_.from_above(count_) = whole_.transmission;
        ++count_;
    }

    RayResponse&& take() { return std::move(whole_); }

private:
    void exchange(const RayPart& part, double self, double inverse, bool leaves) {
        const auto below = whole_.from_below.head(count_);
        auto between = exchange_->between.topLeftCorner(count_, count_);
        if (part.back > 0.0)
            between.noalias() += (weight_ * part.back * inverse) * below * below.transpose();
        if (!leaves)
            exchange_->guided.head(count_) += weight_ * below;
        if (!part.is_source)
            return;
        const double crossing = weight_ * part.fluence * inverse;
        exchange_->between.row(count_).head(count_) += crossing * below.transpose();
        exchange_->between.col(count_).head(count_) += crossing * below;
        exchange_->between(count_, count_) +=
            weight_ * self + crossing * part.fluence * whole_.back_below;
    }

    double weight_;
    RayExchange* exchange_;
    RayResponse whole_;
    Eigen::Index count_ = 0; ///< of sources that were added
};

RayStack::RayStack(double ior_above, std::span<const StackElement> run,
                   std::span<const DepthCells> cells)
    : media_{ior_above} {
    std::size_t slab_index = 0;
    for (const StackElement& element : run) {
        if (const auto* surface = std::get_if<SurfaceValues>(&element)) {
            parts_.push_back({Part::Kind::Interface, media_.size() - 1, 0.0, surface->film,
                              surface->wavelength_nm});
            media_.push_back(surface->ior_below);
        } else if (const auto* slab = std::get_if<SlabValues>(&element)) {
            add_slab(*slab, cells[slab_index++]);
        } else if (std::holds_alternative<DiffuseValues>(element)) {
            parts_.push_back({Part::Kind::Substrate, media_.size() - 1});
            append(weights_, media_.back() * media_.back());
        }
    }
}

void RayStack::add_slab(const SlabValues& slab, const DepthCells& cells) {
    const std::size_t medium = media_.size() - 1;
    if (cells.count() == 0) {
        parts_.push_back({Part::Kind::Clear, medium, slab.depth()});
        return;
    }
    for (int cell = 0; cell < cells.count(); ++cell) {
        const double depth = slab.depth() * cells.share(cell);
        parts_.push_back({Part::Kind::Cell, medium, depth});
        append(weights_, 4.0 * slab.ior * slab.ior);
    }
}

RayResponse RayStack::at(double reference_ior, double reference_g2, double weight,
                         RayExchange* exchange) const {
    const auto g2_of = [&](std::size_t medium) {
        const double n = media_[medium];
        return (n - reference_ior) * (n + reference_ior) + reference_g2;
    };
    Fold fold(sources(), weight, exchange);
    for (const Part& part : parts_) {
        const double g2 = g2_of(part.medium), n = media_[part.medium];
        // along the path per depth; none where the path is evanescent and nothing arrives
        const double slant = g2 > 0.0 ? n / std::sqrt(g2) : 0.0;
        switch (part.kind) {
        case Part::Kind::Interface: {
            const FresnelPair pair =
                filmed_pair(n, media_[part.medium + 1], g2, g2_of(part.medium + 1), part.film,
                            part.wavelength_nm);
            fold.add({pair.transmittance, pair.reflectance, 0.0}, 0.0);
            break;
        }
        case Part::Kind::Clear: {
            const double y = part.depth * slant;
            fold.add({std::exp(-y), 0.0, -std::expm1(-y)}, 0.0);
            break;
        }
        case Part::Kind::Cell: {
            const double y = part.depth * slant;
            const double lost = -std::expm1(-y);
            const double fluence = part.depth > 0.0 ? lost / part.depth : slant;
            fold.add({std::exp(-y), 0.0, lost, true, fluence},
                     2.0 * slant * slant * second_moment(y));
            break;
        }
        case Part::Kind::Substrate:
            fold.add_substrate(g2 > 0.0);
            break;
        }
    }
    return fold.take();
}

} // namespace reradiant
