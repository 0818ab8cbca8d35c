#pragma once

#include "host/fit/result/shared_errors.h"
#include "reradiant/bispectral_data.h"
#include "reradiant/fit.h"
#include "reradiant/layer_stack.h"

#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// Data of a sample under a stack turned into those of the bare substrate.
struct SubstrateData {
    BispectralData data; ///< one block without geometry; of its errors those of single entries
    LayerStack stack;    ///< with the unknown numbers as found
    StackEstimate estimate;
    std::optional<SharedErrors> errors; ///< of `data`, all of them; empty: there was no stack
    bool noise_is_estimated = false;    ///< the standard errors of `data` come from an estimate
    std::vector<std::string> notes;
};

/// Inverts the model `adding`: every block is pi f = T_up T_down B / n_k^2 with B = M (I - diag(r)
/// M)^-1, so B is the weighted mean over the blocks and M = B (I + diag(r) B)^-1. Unknown numbers
/// of the stack are those that make the blocks agree best (Ceres; B itself is projected out, Golub
/// and Pereyra 1973). Emission below the excitation is dark unless `anti_stokes`, so that its noise
/// does not enter; so are emission bands that were not measured, which a note says.
/// Input Error when blocks without geometry meet a stack, when grids share no common one, or when
/// numbers are unknown but there is one geometry only.
SubstrateData invert_stack(const BispectralData& data, const LayerStack& stack,
                           const UnknownLayers& unknown, bool anti_stokes = false);

} // namespace reradiant
