#pragma once

#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

namespace reradiant {

/// What part of the power that a dye absorbs in a band it sends out in each, per quantum yield:
/// `dye_shares` (host/layers/stack/slab_emission.h) of an emission that is known by its mean over
/// every band, with derivatives. Within a band the emission is linear, as steep as its neighbours
/// say but never below zero, and absorption is the same. What is absorbed at li goes to longer
/// waves alone, over the photons of the emission above li, so that the share of a band l above the
/// absorbing band k is the mean of e(l) times above(k), and that of k itself is within(k).
class EmissionShares {
public:
    /// `emission`: power in every band of the grid, >= 0.
    EmissionShares(const Eigen::VectorXd& emission, const WavelengthGrid& bands);

    /// (bands, bands), rows = emission.
    Eigen::MatrixXd matrix() const;

    const Eigen::VectorXd& emission() const { return emission_; }
    /// By the band that absorbs, and their derivatives by the emission of every band, (bands,
    /// bands).
    const Eigen::VectorXd& above() const { return above_; }
    const Eigen::VectorXd& within() const { return within_; }
    const Eigen::MatrixXd& above_by_emission() const { return above_by_emission_; }
    const Eigen::MatrixXd& within_by_emission() const { return within_by_emission_; }

private:
    Eigen::VectorXd emission_, above_, within_;
    Eigen::MatrixXd above_by_emission_, within_by_emission_;
};

} // namespace reradiant
