#include "host/layers/sources/re_emission.h"

#include "host/layers/sources/fixed_point.h"
#include "host/spectral/matrix/linear_systems.h"
#include "reradiant/error.h"

#include <algorithm>

namespace reradiant {

namespace {

bool is_lower(const Eigen::MatrixXd& matrix) {
    for (Eigen::Index i = 1; i < matrix.cols(); ++i)
        if ((matrix.col(i).head(i).array() != 0.0).any())
            return false;
    return true;
}

/// Input Error for what light alone cannot be: (I - T)^-1 of a positive T whose spectral radius is
/// not below 1 has entries below zero.
void check_series(const Eigen::MatrixXd& sum) {
    constexpr double rounding = 1e-9;
    if (sum.allFinite() && sum.minCoeff() >= -rounding * sum.maxCoeff())
        return;
    throw_input_error({}, "what the dyes send out excites them without end",
                      "their shares and the re-radiation matrix must send out less than they take");
}

} // namespace

ReEmission::ReEmission(std::vector<std::shared_ptr<const SourceTransport>> by_band,
                       const StackCells& cells, const std::vector<Eigen::MatrixXd>& slabs,
                       const Eigen::MatrixXd& substrate,
                       const std::vector<ScatteringTransport>& scattering)
    : by_band_(std::move(by_band)) {
    Eigen::Index first = 0;
    for (std::size_t slab = 0; slab < cells.size(); ++slab) {
        const int count = cells[slab].count();
        if (count == 0)
            continue;
        Eigen::VectorXd shares(count);
        for (int cell = 0; cell < count; ++cell)
            shares(cell) = cells[slab].share(cell);
        groups_.push_back({first, shares, slabs[slab], slab});
        first += count;
    }
    if (substrate.size() > 0)
        groups_.push_back({first, Eigen::VectorXd::Ones(1), substrate, cells.size()});
    for (const Group& group : groups_)
        stokes_only_ = stokes_only_ && is_lower(group.emission);
    for (Eigen::Index band = 0; band < bands(); ++band) {
        const Eigen::VectorXd within = within_band(band);
        own_series_.emplace_back();
        if ((within.array() != 0.0).any()) {
            own_series_.back() =
                series_within(band, within, scattering[static_cast<std::size_t>(band)]);
            check_series(own_series_.back());
        }
    }
}

/// What sources send out in a band in the end of what they send out in it first: (I - S K)^-1. Of S
/// = E + R, where E is what dyes scatter and L the exchange with that scattering, it is (I + E L)
/// (I - R L)^-1; of each column, what is not sent out again within the band is made to be all that
/// came, as it is without scattering.
Eigen::MatrixXd ReEmission::series_within(Eigen::Index band, const Eigen::VectorXd& within,
                                          const ScatteringTransport& scattering) const {
    const Eigen::Index n = within.size();
    const auto one = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd again = within.asDiagonal() * at(band).exchange();
    if (!scattering.transport)
        return left_quotient(one - again, one);
    const Eigen::VectorXd elastic = scattered(scattering.depths);
    const Eigen::MatrixXd& exchange = scattering.transport->exchange();
    const Eigen::MatrixXd first =
        left_quotient(one - (within - elastic).asDiagonal() * exchange, one);
    Eigen::MatrixXd series = first + elastic.asDiagonal() * (exchange * first);
    const Eigen::RowVectorXd lost = Eigen::RowVectorXd::Ones(n) - again.colwise().sum();
    const Eigen::RowVectorXd all = lost * series;
    return series * all.cwiseInverse().asDiagonal();
}

/// The optical depths of cells that scatter.
Eigen::VectorXd ReEmission::scattered(const std::vector<double>& depths) const {
    Eigen::VectorXd scattered = Eigen::VectorXd::Zero(at(0).sources());
    for (const Group& group : groups_)
        if (group.slab < depths.size())
            scattered.segment(group.first, group.shares.size()) = depths[group.slab] * group.shares;
    return scattered;
}

/// What sources send out in a band of what reaches them in the same one.
Eigen::VectorXd ReEmission::within_band(Eigen::Index band) const {
    Eigen::VectorXd within = Eigen::VectorXd::Zero(at(band).sources());
    for (const Group& group : groups_)
        within.segment(group.first, group.shares.size()) =
            group.emission(band, band) * group.shares;
    return within;
}

/// What they send out in it of what reaches them in all bands.
Eigen::VectorXd ReEmission::driven(Eigen::Index band, const Eigen::MatrixXd& reached) const {
    Eigen::VectorXd sent = Eigen::VectorXd::Zero(reached.rows());
    const Eigen::Index last = stokes_only_ ? band + 1 : bands();
    for (const Group& group : groups_) {
        const auto own = reached.block(group.first, 0, group.shares.size(), last);
        sent.segment(group.first, group.shares.size()) =
            group.shares.cwiseProduct(own * group.emission.row(band).head(last).transpose());
    }
    return sent;
}

/// What is sent out band after band, each with what the bands before it sent out now, and with what
/// the others sent out before.
Eigen::MatrixXd ReEmission::pass(Eigen::Index excitation, const Eigen::VectorXd& reached,
                                 Eigen::MatrixXd sent) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(reached.size(), bands());
    const Eigen::Index first = stokes_only_ ? excitation : 0;
    for (Eigen::Index band = first; band < bands() && !stokes_only_; ++band)
        all.col(band).noalias() = at(band).exchange() * sent.col(band);
    all.col(excitation) += reached;
    for (Eigen::Index band = first; band < bands(); ++band) {
        // what reaches the sources in this band by their own doing is in its own series
        all.col(band).setZero();
        if (band == excitation)
            all.col(band) = reached;
        sent.col(band) = driven(band, all);
        const Eigen::MatrixXd& series = own_series_[static_cast<std::size_t>(band)];
        if (series.size() > 0)
            sent.col(band) = series * sent.col(band);
        all.col(band).noalias() += at(band).exchange() * sent.col(band);
    }
    return sent;
}

Eigen::MatrixXd ReEmission::sent(Eigen::Index excitation, const Eigen::VectorXd& reached) const {
    const Eigen::Index n = reached.size();
    const Eigen::MatrixXd once = pass(excitation, reached, Eigen::MatrixXd::Zero(n, bands()));
    if (stokes_only_)
        return once;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd whole = fixed_point(once.reshaped(), [&](const Eigen::VectorXd& sent) {
        return Eigen::VectorXd(pass(excitation, none, sent.reshaped(n, bands())).reshaped());
    });
    const Eigen::MatrixXd all = whole.reshaped(n, bands());
    if (reached.minCoeff() >= 0.0)
        check_series(all);
    return all;
}

} // namespace reradiant
