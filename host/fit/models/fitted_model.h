#pragma once

#include "host/fit/factors/factor_start.h"
#include "host/fit/solver/non_negative_solver.h"

#include <Eigen/Core>

#include <cstddef>

namespace reradiant {

/// A model of the fluorescent part. Matrices are in units of the target's scale.
class FittedModel : public NonNegativeModel {
public:
    /// (emission, excitation), zero where emission is not allowed.
    virtual Eigen::MatrixXd matrix(const Eigen::VectorXd& parameters) const = 0;
    /// Numbers that the compact form stores.
    virtual std::size_t stored_numbers() const = 0;
};

/// A model that is a sum of terms, each an emission times an excitation curve.
class TermModel : public FittedModel {
public:
    virtual int terms() const = 0;
    /// The one term that a parameter belongs to.
    virtual int term_of(Eigen::Index parameter) const = 0;
    /// Curves whose products, summed over the terms, are the matrix where emission is allowed.
    virtual FactorCurves curves(const Eigen::VectorXd& parameters) const = 0;
    /// Derivative of every entry (column-major order of `matrix`) by every parameter.
    virtual Eigen::MatrixXd entry_jacobian(const Eigen::VectorXd& parameters) const = 0;
    /// Derivative by every parameter of a linear prior's residuals, in standard deviations; no
    /// rows: there is none that counts.
    virtual Eigen::MatrixXd prior_jacobian() const { return {}; }
    /// Numbers of a term that may be chosen at will: what one curve gives the other takes.
    virtual int free_units() const = 0;
};

} // namespace reradiant
