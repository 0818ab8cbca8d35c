#include "host/fit/result/fit_memory.h"

#include "host/base/memory_limit.h"

#include <cmath>

namespace reradiant {

namespace {

/// Bytes of the largest problem that is solved. `factors` and `gaussians` hold a row of derivatives
/// an entry, as the solver's, as a sparse matrix with its indices and transposed: some 40 bytes a
/// number. `matrix` factorises a precision on a grid, whose fill grows as n log n.
double solver_bytes(double entries, double curves, const FitSettings& settings) {
    const double terms = settings.rank.value_or(
        settings.model == FitModel::Factors ? largest_factor_rank : largest_gaussian_count);
    if (settings.model == FitModel::Matrix)
        return entries * 400.0 * std::log2(entries + 2.0);
    // An entry depends on two numbers of a term's curves, and on all six of a Gaussian; covariances
    // are dense between all numbers, and of derivatives there are four copies on the way there.
    // A kept covariance takes two more.
    const double copies = settings.covariance ? 6.0 : 4.0;
    const double numbers = terms * (settings.model == FitModel::Factors ? curves : 6.0);
    return entries * terms * (settings.model == FitModel::Factors ? 2.0 : 6.0) * 40.0 +
           8.0 * 3.0 * numbers * numbers + 8.0 * copies * entries * numbers;
}

} // namespace

void check_fit_memory(const BispectralData& data, const FitSettings& settings,
                      std::uint64_t limit_bytes) {
    const double emission = data.emission.count, excitation = data.excitation.count;
    const double entries = emission * excitation;
    // Values, errors, weights, target, result and report.
    const double held =
        entries * sizeof(double) * (2.0 * static_cast<double>(data.blocks.size()) + 16.0);
    check_memory_limit({data.file.string()}, "the fit",
                       held + solver_bytes(entries, emission + excitation, settings), limit_bytes,
                       "fit on fewer bands, or fewer terms (--rank)");
}

} // namespace reradiant
