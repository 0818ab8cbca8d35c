#pragma once

#include "host/fit/dye/dye_data.h"
#include "host/fit/factors/smooth_basis.h"
#include "host/fit/solver/non_negative_solver.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace reradiant {

/// A sample, what was measured of it, and how much dye it holds beside the others.
struct DyeSampleData {
    std::shared_ptr<const DyeStack> stack;
    double depth_factor = 1.0; ///< optical depth of the layer over absorption
    const DyeDataSet* data = nullptr;
};

/// All that is known before the dyes are.
struct DyeProblem {
    std::vector<DyeSampleData> samples;
    WavelengthGrid bands; ///< common to emission and excitation
    BandRange emission, excitation;
    Eigen::VectorXd lamp;        ///< by excitation band, mean 1: what the data hold of it
    bool fits_scale = false;     ///< the data's unit is not known
    bool fits_substrate = false; ///< the substrate's reflectance is not known

    Eigen::Index used_count() const;
    /// Depth over absorption of the sample that has most dye.
    double largest_factor() const;
    /// Largest absorption that the tables of all samples hold.
    double largest_absorption() const;
};

/// Parameters by name: what a fit says of the dyes.
struct DyeParameters {
    Eigen::MatrixXd absorption, emission; ///< (bands, dyes); emission adds up to 1
    Eigen::VectorXd quantum_yield;        ///< by dye
    double scale = 1.0;
    Eigen::VectorXd reflectance; ///< by band; empty: not fitted
};

/// The least-squares problem of the dyes in a layer, for the solver of non-negative parameters:
/// coefficients of absorption and emission, quantum yields, and what else is unknown. In data of an
/// unknown unit the scale is that of what the first dye sends out, its yield included: the yield
/// itself is seen there by what is re-absorbed alone.
class DyeModel final : public NonNegativeModel {
public:
    DyeModel(const DyeProblem& problem, SmoothBasis absorption, SmoothBasis emission, int dyes);

    std::vector<int> block_sizes() const override;
    void add_residuals(ceres::Problem& problem, const std::vector<double*>& blocks) const override;

    int dyes() const { return dyes_; }
    Eigen::Index size() const;
    Eigen::Index residuals() const { return problem_->used_count() + dyes_ + priors(); }
    const DyeProblem& problem() const { return *problem_; }
    const SmoothBasis& absorption_basis() const { return absorption_; }
    const SmoothBasis& emission_basis() const { return emission_; }
    /// Keeps a parameter where it is.
    void hold(Eigen::Index parameter) { held_[static_cast<std::size_t>(parameter)] = true; }
    void release(Eigen::Index parameter) { held_[static_cast<std::size_t>(parameter)] = false; }
    /// Says by which bands the unit of each dye's emission is kept: their sum stays, which changes
    /// nothing that is seen. It is that of the bands from the peak up, which are seen best.
    void keep_unit(const Eigen::MatrixXd& emission);

    DyeParameters parameters(const Eigen::VectorXd& packed) const;
    /// The parameters nearest to some spectra.
    Eigen::VectorXd packed(const DyeParameters& parameters) const;
    /// First parameter of the absorption of a dye, of its emission, of the yields, of the scale and
    /// of the reflectance.
    struct Places {
        Eigen::Index absorption, emission, quantum_yield, scale, reflectance;
    };
    Places places() const;

    /// Model of every block of every sample, in the data's unit.
    std::vector<std::vector<Eigen::MatrixXd>> images(const Eigen::VectorXd& packed) const;
    /// Weighted residuals, then rows for the unit of each dye's emission and for the prior, and
    /// their derivatives where they are asked for. The prior is far wider than what data say, but
    /// keeps numbers that they say nothing of within reason: depths of some 10, and emissions of
    /// some 0.3 of the whole in a band.
    void evaluate(const Eigen::VectorXd& packed, Eigen::VectorXd& residuals,
                  Eigen::MatrixXd* jacobian) const;
    /// False where a depth is beyond what the tables hold.
    bool is_within_tables(const Eigen::VectorXd& packed) const;
    /// Of the data alone.
    double chi_squared(const Eigen::VectorXd& packed) const;

private:
    DyeValues values(const DyeParameters& parameters, const DyeSampleData& sample) const;
    Eigen::MatrixXd chained(const DyeImage& image, const DyeParameters& parameters,
                            double depth_factor) const;
    double gain(const DyeParameters& parameters) const;
    Eigen::Index priors() const { return places().quantum_yield; }
    double prior_weight(Eigen::Index parameter) const;

    const DyeProblem* problem_;
    SmoothBasis absorption_, emission_;
    int dyes_;
    std::vector<bool> held_; ///< by parameter
    Eigen::MatrixXd unit_;   ///< (emission bands, dyes)
    Eigen::VectorXd unit_sum_;
};

} // namespace reradiant
