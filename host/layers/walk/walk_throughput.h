#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "host/layers/walk/walk_tally.h"

#include <Eigen/Core>

#include <optional>

namespace reradiant {

/// `WalkThroughput` holds the weights that one walk carries, those of all bands or that of the band
/// that the walk is in, and what its light has met.
class WalkThroughput {
public:
    /// `band`: where the walk starts; none: it carries all bands.
    WalkThroughput(const WalkMaterial& material, std::optional<int> band)
        : material_(material), start_(band), band_(band.value_or(0)),
          rows_(Eigen::ArrayXd::Ones(band ? 1 : material.bands())) {}

    const WalkElements& elements() const {
        return start_ ? material_.at_band(band_) : material_.shared();
    }
    const WalkMaterial& material() const { return material_; }
    int band() const { return band_; }
    bool reached() const { return reached_; }
    const Eigen::ArrayXd& rows() const { return rows_; }
    double largest() const { return rows_.maxCoeff() * largest_full_; }

    void reach() { reached_ = true; }
    void spread() { is_spread_ = true; }
    void scale(double factor) { rows_ *= factor; }
    void absorb(const Eigen::ArrayXd& depth) { rows_ *= (-depth).exp(); }
    /// Lets the substrate send the light back, in whichever bands it does.
    void re_radiate(WalkRandom& random);
    /// Lets the dyes of a slab send out what they took up by events of depth `tau_emission`, in a
    /// band that is drawn.
    void re_emit(const WalkElement& slab, double tau_emission, WalkRandom& random) {
        scale(1.0 / tau_emission);
        draw_band(slab.emission, random.next());
    }

    /// Adds `factor` times what is carried to the part of the tally that it belongs to.
    void add_to(WalkTally::Parts& parts, const Eigen::ArrayXd& factor) const;
    void add_to(Eigen::VectorXd& sums, double factor) const {
        add_rows(sums, Eigen::ArrayXd::Constant(rows_.size(), factor));
    }
    /// Adds what is carried to sums that are shaped as WalkTally::Parts::slab.
    void add_to(Eigen::MatrixXd& sums) const { add_slab(sums, Eigen::ArrayXd::Ones(rows_.size())); }

private:
    template <typename Vector>
    void add_rows(Vector&& sums, const Eigen::ArrayXd& factor) const {
        if (start_)
            sums(band_) += rows_(0) * factor(0);
        else
            sums.array() += rows_ * factor;
    }
    void add_slab(Eigen::MatrixXd& sums, const Eigen::ArrayXd& factor) const {
        if (material_.is_dyed())
            sums(band_, *start_) += rows_(0) * factor(0);
        else
            add_rows(sums.col(0), factor);
    }
    void draw_band(const Eigen::Ref<const Eigen::VectorXd>& column, double u);

    const WalkMaterial& material_;
    std::optional<int> start_;
    int band_;
    Eigen::ArrayXd rows_;
    Eigen::MatrixXd full_; ///< (emission, excitation) once something has been re-radiated
    double largest_full_ = 1.0;
    bool reached_ = false, is_spread_ = false;
};

} // namespace reradiant
