#pragma once

#include "reradiant/measure.h"

#include <Eigen/Core>

#include <vector>

namespace reradiant {

/// Which bands light can leave in, (emission, excitation).
using PossiblePairs = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Returns the pairs that light can leave and come at: the diagonal, Stokes shifts, and where a
/// coupling has entries above the diagonal, what these reach; in any number of steps where
/// `is_repeated`, because something sends the light back to be shifted again. Only the diagonal
/// where nothing fluoresces. `couplings`: (bands, bands) each, rows = emission, or without entries.
PossiblePairs possible_pairs(const std::vector<Eigen::MatrixXd>& couplings, int bands,
                             bool is_repeated);

/// A `RowWriter` appends the rows of a measurement, part by part.
class RowWriter {
public:
    /// `possible`: the pairs of bands that rows of light which may change its band are written for.
    RowWriter(Measurement& measurement, PossiblePairs possible)
        : measurement_(measurement), possible_(std::move(possible)) {}

    /// Adds a row for every possible pair of bands, of `values` (bands, bands), rows = emission; or
    /// for every band, of values (bands, 1). `errors`: standard errors of the same shape, or 0.
    void add(const MeasureRow& angles, MeasuredPart part, const Eigen::MatrixXd& values,
             const Eigen::MatrixXd& errors = {});

private:
    Measurement& measurement_;
    PossiblePairs possible_;
};

/// The angles of rows that stand for all directions of a side (theta_o and phi are not used), or
/// for one.
inline MeasureRow rows_at(double theta_i_deg, double theta_o_deg = 0.0, double phi_deg = 0.0) {
    return {theta_i_deg, theta_o_deg, phi_deg, 0.0, 0.0, 0.0, 0.0, MeasuredPart::Diffuse};
}

} // namespace reradiant
