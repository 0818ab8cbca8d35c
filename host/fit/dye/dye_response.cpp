#include "host/fit/dye/dye_response.h"

#include "host/spectral/matrix/linear_systems.h"

#include <tbb/parallel_for.h>

#include <utility>

namespace reradiant {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Light by band, (sources, excitations) or (sources, emissions).
using ByBand = std::vector<Matrix>;

/// One level of cells of a sample whose dyes are known: everything that all views share.
class Coupling {
public:
    Coupling(const DyeStack& stack, DyeStack::Level level, const DyeValues& values)
        : groups_(stack.groups(level)), bands_(stack.bands().count) {
        for (Index band = 0; band < bands_; ++band)
            transports_.push_back(stack.at(level, band, values.depth.row(band).sum()));
        shares_.resize(sources());
        for (const SourceGroup& group : groups_) {
            emissions_.push_back(emission_of(group, values));
            shares_.segment(group.first, group.count) = group.shares;
        }
    }

    Index bands() const { return bands_; }
    Index sources() const { return groups_.back().first + groups_.back().count; }
    const DepthTransport& at(Index band) const { return pair(band).value; }
    const DepthTransport& slope_at(Index band) const { return pair(band).slope; }

    /// The cells whose dyes are unknown, with their shares.
    const SourceGroup& unknown() const {
        return *std::ranges::find_if(groups_, &SourceGroup::is_unknown);
    }

    /// What sources send out in a band of what reaches them in the bands below it.
    Matrix driven(Index band, const ByBand& reached, Index columns) const {
        Matrix sum = Matrix::Zero(sources(), columns);
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (Index k = 0; k < band; ++k)
                add(emissions_[g](band, k), groups_[g], reached[static_cast<std::size_t>(k)], sum);
        return shares_.asDiagonal() * sum;
    }

    /// The same backwards: what is seen of the bands above, by what reaches sources in this one.
    Matrix driving(Index band, const ByBand& of_sent, Index columns) const {
        Matrix sum = Matrix::Zero(sources(), columns);
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (Index k = band + 1; k < bands_; ++k)
                add(emissions_[g](k, band), groups_[g], of_sent[static_cast<std::size_t>(k)], sum);
        return shares_.asDiagonal() * sum;
    }

    /// What each source sends out in a band of what reaches it in the same band.
    Vector within(Index band) const {
        Vector own(sources());
        for (std::size_t g = 0; g < groups_.size(); ++g)
            own.segment(groups_[g].first, groups_[g].count).setConstant(emissions_[g](band, band));
        return own.cwiseProduct(shares_);
    }

private:
    Matrix emission_of(const SourceGroup& group, const DyeValues& values) const {
        Matrix sum = group.known.size() > 0 ? group.known : Matrix::Zero(bands_, bands_);
        if (!group.is_unknown) {
            if (group.count == 1 && values.reflectance_added.size() > 0)
                sum.diagonal() += values.reflectance_added;
            return sum;
        }
        for (std::size_t d = 0; d < values.shares.size(); ++d) {
            const auto dye = static_cast<Index>(d);
            sum += values.quantum_yield(dye) * values.shares[d].matrix() *
                   values.depth.col(dye).asDiagonal();
        }
        return sum;
    }

    const DepthTransportPair& pair(Index band) const {
        return transports_[static_cast<std::size_t>(band)];
    }
    static void add(double emission, const SourceGroup& group, const Matrix& from, Matrix& sum) {
        if (emission != 0.0)
            sum.middleRows(group.first, group.count) +=
                emission * from.middleRows(group.first, group.count);
    }

    const std::vector<SourceGroup>& groups_;
    Index bands_;
    std::vector<DepthTransportPair> transports_;
    std::vector<Matrix> emissions_; ///< by group, (bands, bands)
    Vector shares_;                 ///< by source
};

struct Light {
    ByBand reached, sent;
};

/// Follows light that comes in by one view, band after band.
Light forward(const Coupling& coupling, Index view, const BandRange& excitation) {
    Light light;
    for (Index o = 0; o < coupling.bands(); ++o) {
        Matrix driven = coupling.driven(o, light.reached, excitation.count);
        Matrix reached = Matrix::Zero(driven.rows(), driven.cols());
        if (const Index i = o - excitation.first; i >= 0 && i < excitation.count)
            reached.col(i) = coupling.at(o).reached.col(view);
        const Matrix& exchange = coupling.at(o).exchange;
        const Vector within = coupling.within(o);
        driven += within.asDiagonal() * reached;
        const Matrix system =
            Matrix::Identity(within.size(), within.size()) - Matrix(within.asDiagonal() * exchange);
        light.sent.push_back(left_quotient(system, driven));
        light.reached.push_back(reached + exchange * light.sent.back());
    }
    return light;
}

/// How much of what a view sees there would be more of light that sources send out or that reaches
/// them, band by band.
struct Adjoint {
    ByBand of_reached, of_sent;
};

Adjoint backward(const Coupling& coupling, Index view, const BandRange& emission) {
    const auto bands = static_cast<std::size_t>(coupling.bands());
    Adjoint adjoint{ByBand(bands), ByBand(bands)};
    for (Index k = coupling.bands() - 1; k >= 0; --k) {
        const Matrix later = coupling.driving(k, adjoint.of_sent, emission.count);
        Matrix seen = Matrix::Zero(later.rows(), later.cols());
        if (const Index row = k - emission.first; row >= 0 && row < emission.count)
            seen.col(row) = coupling.at(k).seen.col(view);
        const Matrix& exchange = coupling.at(k).exchange;
        const Vector within = coupling.within(k);
        const Matrix system = Matrix::Identity(within.size(), within.size()) -
                              Matrix(exchange.transpose() * within.asDiagonal());
        Matrix& sent = adjoint.of_sent[static_cast<std::size_t>(k)];
        sent = left_quotient(system, seen + exchange.transpose() * later);
        adjoint.of_reached[static_cast<std::size_t>(k)] = later + within.asDiagonal() * sent;
    }
    return adjoint;
}

/// The derivatives of one view's image on one level of cells.
class Derivatives {
public:
    Derivatives(const Coupling& coupling, const DyeValues& values, Index view,
                const BandRange& emission, const BandRange& excitation, const Light& light)
        : coupling_(coupling), values_(values), view_(view), emission_(emission),
          excitation_(excitation), light_(light), adjoint_(backward(coupling, view, emission)) {}

    void add_to(double weight, DyeImage& image) const {
        for (Index band = 0; band < coupling_.bands(); ++band) {
            const Vector moved = weight * by_transport(band).reshaped();
            for (Index dye = 0; dye < values_.depth.cols(); ++dye)
                image.by_depth.col(dye * coupling_.bands() + band) += moved;
            if (values_.reflectance_added.size() > 0)
                image.by_reflectance.col(band) +=
                    weight * (of_sent(band).bottomRows(1).transpose() * reached(band).bottomRows(1))
                                 .reshaped();
        }
        for (Index dye = 0; dye < values_.depth.cols(); ++dye)
            add_dye(weight, dye, image);
    }

private:
    const Matrix& of_sent(Index band) const {
        return adjoint_.of_sent[static_cast<std::size_t>(band)];
    }
    const Matrix& reached(Index band) const {
        return light_.reached[static_cast<std::size_t>(band)];
    }

    /// What a band's transport does as the depth there grows.
    Matrix by_transport(Index band) const {
        const auto k = static_cast<std::size_t>(band);
        const DepthTransport& slope = coupling_.slope_at(band);
        const Matrix& of_reached = adjoint_.of_reached[k];
        Matrix moved = of_reached.transpose() * (slope.exchange * light_.sent[k]);
        if (const Index i = band - excitation_.first; i >= 0 && i < excitation_.count)
            moved.col(i) += of_reached.transpose() * slope.reached.col(view_);
        if (const Index o = band - emission_.first; o >= 0 && o < emission_.count)
            moved.row(o) += slope.seen.col(view_).transpose() * light_.sent[k];
        return moved;
    }

    /// What a dye sends out: by its depth, its yield and its emission. A band's share goes to the
    /// bands above it and to itself, by factors that all of the emission above makes.
    void add_dye(double weight, Index dye, DyeImage& image) const {
        const SourceGroup& cells = coupling_.unknown();
        const EmissionShares& shares = values_.shares[static_cast<std::size_t>(dye)];
        const double yield = values_.quantum_yield(dye);
        const Index bands = coupling_.bands();
        const auto cells_of = [&](const Matrix& all) {
            return all.middleRows(cells.first, cells.count);
        };
        const ByBand above = emitted_above(cells, shares); // by the band that absorbs
        const Index entries = emission_.count * excitation_.count;
        Matrix to_above(entries, bands), to_itself(entries, bands);
        Matrix driving = Matrix::Zero(cells.count, excitation_.count);
        for (Index k = 0; k < bands; ++k) {
            const double depth = values_.depth(k, dye);
            const auto arrived = cells_of(reached(k));
            const Matrix own = cells.shares.asDiagonal() * cells_of(of_sent(k));
            to_above.col(k) = (above[static_cast<std::size_t>(k)].transpose() * arrived).reshaped();
            to_itself.col(k) = (own.transpose() * arrived).reshaped();
            const Vector sent =
                shares.above()(k) * to_above.col(k) + shares.within()(k) * to_itself.col(k);
            image.by_depth.col(dye * bands + k) += weight * yield * sent;
            image.by_yield.col(dye) += weight * depth * sent;
            image.by_emission.col(dye * bands + k) +=
                weight * yield * (own.transpose() * driving).reshaped();
            driving += depth * shares.above()(k) * arrived;
        }
        const auto depths = values_.depth.col(dye).asDiagonal();
        image.by_emission.middleCols(dye * bands, bands) +=
            weight * yield *
            (to_above * (depths * shares.above_by_emission()) +
             to_itself * (depths * shares.within_by_emission()));
    }

    /// By band: what the view sees of the whole emission above it.
    ByBand emitted_above(const SourceGroup& cells, const EmissionShares& shares) const {
        const auto bands = static_cast<std::size_t>(coupling_.bands());
        ByBand above(bands, Matrix::Zero(cells.count, emission_.count));
        for (std::size_t k = bands - 1; k > 0; --k) {
            const auto band = static_cast<Index>(k);
            above[k - 1] = above[k] + (shares.emission()(band) * cells.shares).asDiagonal() *
                                          of_sent(band).middleRows(cells.first, cells.count);
        }
        return above;
    }

    const Coupling& coupling_;
    const DyeValues& values_;
    Index view_;
    const BandRange &emission_, &excitation_;
    const Light& light_;
    Adjoint adjoint_;
};

DyeImage dark_image(const DyeValues& values, const BandRange& emission, const BandRange& excitation,
                    bool with_derivatives) {
    DyeImage image{Matrix::Zero(emission.count, excitation.count), {}, {}, {}, {}};
    if (!with_derivatives)
        return image;
    const Index entries = image.value.size(), bands = values.depth.rows();
    image.by_depth = image.by_emission = Matrix::Zero(entries, values.depth.size());
    image.by_yield = Matrix::Zero(entries, values.depth.cols());
    if (values.reflectance_added.size() > 0)
        image.by_reflectance = Matrix::Zero(entries, bands);
    return image;
}

} // namespace

std::vector<DyeImage> dye_images(const DyeStack& stack, const DyeValues& values,
                                 const BandRange& emission, const BandRange& excitation,
                                 bool with_derivatives) {
    std::vector<DyeImage> images(static_cast<std::size_t>(stack.views()),
                                 dark_image(values, emission, excitation, with_derivatives));
    for (const auto& [level, weight] :
         {std::pair{DyeStack::Fine, 4.0 / 3.0}, std::pair{DyeStack::Coarse, -1.0 / 3.0}}) {
        const Coupling coupling(stack, level, values);
        tbb::parallel_for(Index{0}, stack.views(), [&, weight = weight](Index view) {
            DyeImage& image = images[static_cast<std::size_t>(view)];
            const Light light = forward(coupling, view, excitation);
            for (Index row = 0; row < emission.count; ++row) {
                const Index band = emission.first + row;
                image.value.row(row) += weight * coupling.at(band).seen.col(view).transpose() *
                                        light.sent[static_cast<std::size_t>(band)];
            }
            if (with_derivatives)
                Derivatives(coupling, values, view, emission, excitation, light)
                    .add_to(weight, image);
        });
    }
    return images;
}

} // namespace reradiant
