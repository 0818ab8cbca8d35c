#pragma once

#include "host/fit/dye/dye_fit.h"
#include "host/fit/dye/dye_response.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace reradiant {

/// One block of a data set, ready to be fitted; matrices are (emission, excitation).
struct DyeBlock {
    Eigen::MatrixXd value;  ///< 0 where the weight is 0
    Eigen::MatrixXd weight; ///< 1 / standard error, 0: not used
};

/// One data set, ready to be fitted.
struct DyeDataSet {
    BispectralData data; ///< with gaps where it is masked
    std::vector<DyeView> views;
    std::vector<DyeBlock> blocks; ///< by view
    FitMask mask;
    int saturated = 0;
    bool noise_is_estimated = false;
    double noise = 0.0; ///< median standard error
    std::vector<std::string> notes;

    Eigen::Index used_count() const;
};

/// Returns the directions of a data set's blocks; a block without any is seen as the data's line
/// `geometry` says. Input Error for what says neither, and for light from all sides.
std::vector<DyeView> views_of(const BispectralData& data);

/// Leaves out what was not measured, what is masked, spills from the diagonal, lies below the
/// excitation or is saturated, and weighs the rest by its errors. The diagonal is used where
/// `with_diagonal` says so, in directional blocks.
DyeDataSet prepare_dye_data(const BispectralData& data, const DyeFitSettings& settings,
                            bool with_diagonal);

} // namespace reradiant
