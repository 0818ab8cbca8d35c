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

/// Light that leaves on one side: `diffuse` and `slab` as RowWriter::add takes values, `specular`
/// by band. Its errors have the same shapes, or no entries.
struct PartValues {
    Eigen::MatrixXd diffuse, slab;
    Eigen::VectorXd specular;
};

/// `PartRows` appends the rows of the parts that a material may have.
class PartRows {
public:
    PartRows(Measurement& measurement, const LayerStack& stack, PossiblePairs possible)
        : rows_(measurement, std::move(possible)), is_sheet_(stack.is_sheet()),
          may_spread_(stack.scatters() || stack.is_dyed()) {}

    void add_reflected(const MeasureRow& angles, const PartValues& values,
                       const PartValues& errors = {});
    /// Of sheets, hemispherical. `diffuse` is not used.
    void add_transmitted(const MeasureRow& angles, const PartValues& values,
                         const PartValues& errors = {});
    /// Where there is any.
    void add_guided(const MeasureRow& angles, const Eigen::MatrixXd& values,
                    const Eigen::MatrixXd& errors = {});

private:
    RowWriter rows_;
    bool is_sheet_, may_spread_;
};

/// The angles of rows that stand for all directions of a side (theta_o and phi are not used), or
/// for one.
inline MeasureRow rows_at(double theta_i_deg, double theta_o_deg = 0.0, double phi_deg = 0.0) {
    return {theta_i_deg, theta_o_deg, phi_deg, 0.0, 0.0, 0.0, 0.0, MeasuredPart::Diffuse};
}

} // namespace reradiant
