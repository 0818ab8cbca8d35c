#include "host/layers/sources/emitting_stack.h"

#include "host/layers/sources/coarse_sources.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Cosine in a slab of the most grazing light from the air, but for light so close to grazing that
/// hardly any comes.
double most_grazing(const SlabValues& slab) {
    constexpr double least = 0.01;
    const double n = slab.ior;
    return n > 1.0 ? std::max(std::sqrt((n - 1.0) * (n + 1.0)) / n, least) : least;
}

/// Largest extinction depth of every slab over all bands, along the path of the most grazing light;
/// 0 for one without dyes.
std::vector<double> depths_of_dyed(const DyedStack& stack) {
    std::vector<double> depths(stack.slabs.size(), 0.0);
    for (const StackElements& elements : stack.by_band) {
        std::size_t slab_index = 0;
        for (const StackElement& element : elements)
            if (const auto* slab = std::get_if<SlabValues>(&element)) {
                if (stack.slabs[slab_index].size() > 0)
                    depths[slab_index] =
                        std::max(depths[slab_index], slab->depth() / most_grazing(*slab));
                ++slab_index;
            }
    }
    return depths;
}

} // namespace

StackCells stack_cells(const DyedStack& stack, int cells_per_octave) {
    StackCells cells;
    for (const double depth : depths_of_dyed(stack))
        cells.push_back(depth > 0.0 ? depth_cells(depth, cells_per_octave) : DepthCells{});
    return cells;
}

EmittingStack::EmittingStack(DyedStack stack) : stack_(std::move(stack)) {
    constexpr int most_cells_per_octave = 32;
    for (int count = 4; count <= most_cells_per_octave; count *= 2) {
        const Level fine = make_level(count), middle = make_coarser(fine);
        const Level coarse = make_coarser(middle);
        const Eigen::MatrixXd last = probe(coarse, middle), next = probe(middle, fine);
        const double largest = next.cwiseAbs().maxCoeff();
        error_ = largest > 0.0 ? (next - last).cwiseAbs().maxCoeff() / largest : 0.0;
        levels_ = {middle, fine};
        if (error_ <= tolerance)
            break;
    }
}

EmittingStack::EmittingStack(DyedStack stack, int cells_per_octave) : stack_(std::move(stack)) {
    const Level fine = make_level(cells_per_octave);
    levels_ = {make_coarser(fine), fine};
}

EmittingStack::Level EmittingStack::make_level(int cells_per_octave) const {
    Level level{stack_cells(stack_, cells_per_octave), {}, {}, nullptr, nullptr};
    level.by_band.resize(stack_.by_band.size());
    const auto like_the_last = [&](std::size_t band) {
        return band > 0 && stack_.by_band[band] == stack_.by_band[band - 1];
    };
    tbb::parallel_for(std::size_t{0}, level.by_band.size(), [&](std::size_t band) {
        if (!like_the_last(band))
            level.by_band[band] = source_transport(stack_.by_band[band], level.cells);
    });
    for (std::size_t band = 1; band < level.by_band.size(); ++band)
        if (!level.by_band[band])
            level.by_band[band] = level.by_band[band - 1];
    make_scattering(level);
    make_series(level);
    return level;
}

void EmittingStack::make_scattering(Level& level) const {
    level.scattering.resize(stack_.by_band.size());
    tbb::parallel_for(std::size_t{0}, level.scattering.size(), [&](std::size_t band) {
        const auto dyes =
            scattering_dyes(stack_.by_band[band], stack_.slabs, static_cast<Eigen::Index>(band));
        if (dyes)
            level.scattering[band] = {source_transport(dyes->stack, level.cells), dyes->depths};
    });
}

EmittingStack::Level EmittingStack::make_coarser(const Level& fine) const {
    Level level{coarser(fine.cells), {}, {}, nullptr, nullptr};
    Eigen::Index cells = 0;
    for (const DepthCells& own : fine.cells)
        cells += own.count();
    for (const auto& transport : fine.by_band)
        level.by_band.push_back(coarse_sources(transport, cells));
    for (const ScatteringTransport& own : fine.scattering)
        level.scattering.push_back(
            own.transport ? ScatteringTransport{coarse_sources(own.transport, cells), own.depths}
                          : ScatteringTransport{});
    make_series(level);
    return level;
}

void EmittingStack::make_series(Level& level) const {
    level.all = std::make_shared<ReEmission>(level.by_band, level.cells, stack_.slabs,
                                             stack_.substrate, level.scattering);
    level.slabs_alone = stack_.substrate.size() == 0
                            ? level.all
                            : std::make_shared<ReEmission>(level.by_band, level.cells, stack_.slabs,
                                                           Eigen::MatrixXd(), level.scattering);
}

const ReEmission& EmittingStack::series_of(const Level& level, Part part) const {
    return part == Part::All ? *level.all : *level.slabs_alone;
}

/// What every source sends out, by excitation, of what `reached` says of each band's transport.
template <typename Reached>
std::vector<Eigen::MatrixXd> EmittingStack::sent_by(const ReEmission& series,
                                                    const Reached& reached) const {
    std::vector<Eigen::MatrixXd> sent(static_cast<std::size_t>(bands()));
    tbb::parallel_for(Eigen::Index{0}, bands(), [&](Eigen::Index band) {
        sent[static_cast<std::size_t>(band)] = series.sent(band, reached(series.at(band)));
    });
    return sent;
}

std::vector<Eigen::MatrixXd> EmittingStack::sent_from(const ReEmission& series,
                                                      const AirDirection& from) const {
    return sent_by(series, [&](const SourceTransport& transport) {
        return transport.reached(from.cosine, from.side);
    });
}

std::shared_ptr<const EmittingStack::Sent> EmittingStack::sent(const AirDirection& from,
                                                               Part part) const {
    constexpr std::size_t most_kept = 4;
    const std::scoped_lock lock(mutex_);
    for (const auto& known : recent_)
        if (known->from == from && known->part == part)
            return known;
    auto made =
        std::make_shared<const Sent>(Sent{from, part, sent_from(series_of(levels_[0], part), from),
                                          sent_from(series_of(levels_[1], part), from)});
    recent_.push_front(made);
    if (recent_.size() > most_kept)
        recent_.pop_back();
    return made;
}

/// Sums over the sources what they send out times what `weigh` says of them in every band.
template <typename Weigh>
Eigen::MatrixXd EmittingStack::extrapolated(const Sent& sent, const Weigh& weigh) const {
    Eigen::MatrixXd result(bands(), bands());
    for (Eigen::Index o = 0; o < bands(); ++o) {
        const Eigen::VectorXd coarse = weigh(levels_[0].all->at(o));
        const Eigen::VectorXd fine = weigh(levels_[1].all->at(o));
        for (Eigen::Index i = 0; i < bands(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            result(o, i) =
                (4.0 * fine.dot(sent.fine[k].col(o)) - coarse.dot(sent.coarse[k].col(o))) / 3.0;
        }
    }
    return result;
}

Eigen::MatrixXd EmittingStack::value(const AirDirection& from, const AirDirection& to,
                                     Part part) const {
    return extrapolated(*sent(from, part), [&](const SourceTransport& transport) {
        return Eigen::VectorXd(
            std::numbers::inv_pi *
            transport.reached(to.cosine, to.side).cwiseQuotient(transport.weights()));
    });
}

Eigen::MatrixXd EmittingStack::albedo(const AirDirection& from, Side to, Part part) const {
    return extrapolated(*sent(from, part),
                        [&](const SourceTransport& transport) { return transport.escaped(to); });
}

Eigen::MatrixXd EmittingStack::diffusely_lit(Side from, const AirDirection& to, Part part) const {
    // by reciprocity a source is reached by unit irradiance as it sends its light out there
    const auto reached = [&](const SourceTransport& transport) {
        return Eigen::VectorXd(transport.escaped(from).cwiseProduct(transport.weights()));
    };
    const Sent lit{{},
                   part,
                   sent_by(series_of(levels_[0], part), reached),
                   sent_by(series_of(levels_[1], part), reached)};
    return extrapolated(lit, [&](const SourceTransport& transport) {
        return Eigen::VectorXd(
            transport.reached(to.cosine, to.side).cwiseQuotient(transport.weights()));
    });
}

Eigen::MatrixXd EmittingStack::guided(const AirDirection& from) const {
    return extrapolated(*sent(from, Part::All),
                        [](const SourceTransport& transport) { return transport.guided(); });
}

int EmittingStack::cells_per_octave() const {
    int most = 2;
    for (const DepthCells& cells : levels_.back().cells)
        most = std::max(most, cells.count() > 0 ? cells.cells_per_octave : 0);
    return most;
}

int EmittingStack::cells() const {
    int count = 0;
    for (const DepthCells& cells : levels_.back().cells)
        count += cells.count();
    return count;
}

/// What leaves above of light from above, extrapolated from two levels: (bands, excitations of two
/// directions).
Eigen::MatrixXd EmittingStack::probe(const Level& coarse, const Level& fine) const {
    Eigen::MatrixXd leaving(bands(), 2 * bands());
    Eigen::Index column = 0;
    for (const double cosine : {1.0, 0.3}) {
        const AirDirection from{cosine, Side::Above};
        const std::vector<Eigen::MatrixXd> of_fine = sent_from(*fine.all, from);
        const std::vector<Eigen::MatrixXd> of_coarse = sent_from(*coarse.all, from);
        for (Eigen::Index i = 0; i < bands(); ++i, ++column) {
            const auto k = static_cast<std::size_t>(i);
            for (Eigen::Index o = 0; o < bands(); ++o) {
                const double f = fine.all->at(o).escaped(Side::Above).dot(of_fine[k].col(o));
                const double c = coarse.all->at(o).escaped(Side::Above).dot(of_coarse[k].col(o));
                leaving(o, column) = (4.0 * f - c) / 3.0;
            }
        }
    }
    return leaving;
}

} // namespace reradiant
