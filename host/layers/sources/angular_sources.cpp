#include "host/layers/sources/angular_sources.h"

#include "host/layers/angular/angular_grid.h"
#include "host/layers/angular/invariant_quadrature.h"
#include "host/layers/angular/scatterer.h"
#include "host/layers/angular/scattering_slab.h"
#include "host/layers/sources/flux_section.h"
#include "host/layers/sources/ray_stack.h"
#include "host/layers/stack/directions.h"
#include "host/layers/stack/stack_variants.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace reradiant {

namespace {

FluxSection empty_section(const AngularGrid* upper, const AngularGrid* lower,
                          Eigen::Index sources) {
    const Eigen::Index a = upper ? upper->cells() : 0, b = lower ? lower->cells() : 0;
    FluxSection section;
    section.etendue_above = upper ? upper->etendue() : Eigen::VectorXd();
    section.etendue_below = lower ? lower->etendue() : Eigen::VectorXd();
    section.back_above.setZero(a, a);
    section.back_below.setZero(b, b);
    section.down.setZero(b, a);
    section.up.setZero(a, b);
    section.from_above.setZero(sources, a);
    section.from_below.setZero(sources, b);
    section.between.setZero(sources, sources);
    section.guided.setZero(sources);
    return section;
}

/// A pile between two grids; without a grid there is the air, or a substrate in the pile.
FluxSection pile_section(const RayStack& rays, const AngularGrid* upper, const AngularGrid* lower) {
    FluxSection section = empty_section(upper, lower, rays.sources());
    RayExchange exchange{section.between, section.guided};
    std::vector<double> edges{0.0};
    for (const AngularGrid* grid : {upper, lower})
        if (grid) {
            const std::vector<double> own = grid->invariants();
            edges.insert(edges.end(), own.begin(), own.end());
        }
    std::vector<double> grazing;
    for (const double n : rays.media())
        (rays.sources() > 0 ? grazing : edges).push_back(n * n);
    std::sort(grazing.begin(), grazing.end());
    const double first = rays.media().front();
    integrate_grazing(std::move(edges), grazing, [&](double q, double w) {
        const int u = upper ? cell_at(*upper, q) : -1, l = lower ? cell_at(*lower, q) : -1;
        const RayResponse ray = rays.at(first, first * first - q, w, &exchange);
        if (u >= 0) {
            const double share = w / section.etendue_above(u);
            section.back_above(u, u) += share * ray.back_above;
            section.from_above.col(u) += share * ray.from_above;
        }
        if (l >= 0) {
            const double share = w / section.etendue_below(l);
            section.back_below(l, l) += share * ray.back_below;
            section.from_below.col(l) += share * ray.from_below;
        }
        if (u >= 0 && l >= 0) {
            section.down(l, u) += w * ray.transmission / section.etendue_above(u);
            section.up(u, l) += w * ray.transmission / section.etendue_below(l);
        }
    });
    section.between = exchange.between;
    section.guided = exchange.guided;
    return section;
}

FluxSection scatterer_section(const Scatterer& scatterer) {
    const Eigen::Index a = scatterer.upper.cells(), b = scatterer.lower.cells();
    FluxSection section = empty_section(&scatterer.upper, &scatterer.lower, 0);
    section.back_above = scatterer.response.topLeftCorner(a, a);
    section.up = scatterer.response.topRightCorner(a, b);
    section.down = scatterer.response.bottomLeftCorner(b, a);
    section.back_below = scatterer.response.bottomRightCorner(b, b);
    return section;
}

/// A dyed slab that scatters, put together from its cells. Equal ones come in twos, and the lower
/// half of the slab is the upper one upside down.
class DyedSlabSections {
public:
    DyedSlabSections(const SlabValues& slab, const AngularGrid& grid, const DepthCells& cells)
        : grid_(grid), cells_(cells), weight_(4.0 * slab.ior * slab.ior),
          by_size_(emitting_slabs(grid, slab.tau * cells.share(0),
                                  slab.tau_scattering * cells.share(0), slab.anisotropy,
                                  cells.doublings(cells.count() / 2) + 1)) {}

    FluxSection whole() const {
        const int m = cells_.cells_per_octave;
        FluxSection half = equal_cells(0, m);
        for (int octave = 1; octave < cells_.octaves; ++octave)
            half = section_above(half, equal_cells(cells_.doublings(octave * m), m));
        return section_above(half, upside_down(half));
    }

private:
    FluxSection equal_cells(int size, int count) const {
        if (count == 1)
            return cell(size);
        const FluxSection half = equal_cells(size, count / 2);
        return section_above(half, half);
    }

    FluxSection cell(int size) const {
        const EmittingSlab& own = by_size_[static_cast<std::size_t>(size)];
        FluxSection section = empty_section(&grid_, &grid_, 1);
        section.back_above = section.back_below = own.op.back;
        section.down = section.up = own.op.through;
        section.from_above = section.from_below = own.fluence.transpose();
        section.between(0, 0) = weight_ * own.own_fluence;
        return section;
    }

    const AngularGrid& grid_;
    const DepthCells& cells_;
    double weight_;
    std::vector<EmittingSlab> by_size_; ///< of the thinnest cell, of twice its thickness, ...
};

/// The elements down to the first that scatters, or to the first rough interface.
template <typename Ends>
StackElements run_until(const StackElements& stack, const Ends& ends) {
    return {stack.begin(), std::find_if(stack.begin(), stack.end(), ends)};
}

/// What reaches sources from the air on one side, by direction: what no scatterer met in closed
/// form, and the rest fitted to its values on the cells of the first scatterer.
class ReachedFromAir {
public:
    /// `stack` and `cells` as seen from this side; `from_cells` is what a flux that goes down onto
    /// the first scatterer does at all sources, (sources, cells), the nearest source first.
    ReachedFromAir(const StackElements& stack, const StackCells& cells, const AngularGrid& grid,
                   Eigen::MatrixXd from_cells)
        : breaks_(breaks_in_air(stack)), smooth_(1.0, run_until(stack, scatters), cells),
          unscattered_(1.0, run_until(stack, is_rough_interface), cells), ior_(grid.ior),
          fit_(grid) {
        const Eigen::VectorXd whole = integral_of_cells(grid, from_cells);
        subtract_unscattered(grid, from_cells);
        coefficients_.resize(from_cells.rows(), 0);
        for (Eigen::Index source = 0; source < from_cells.rows(); ++source) {
            const Eigen::VectorXd own = fit_.coefficients(from_cells.row(source).transpose());
            if (source == 0)
                coefficients_.resize(from_cells.rows(), own.size());
            coefficients_.row(source) = own.transpose();
        }
        correct_integral(whole);
    }

    Eigen::VectorXd at(double cos_theta) const {
        const double c = std::clamp(cos_theta, 0.0, 1.0);
        Eigen::VectorXd reached = Eigen::VectorXd::Zero(coefficients_.rows());
        const double through = smooth_.at(1.0, c * c).transmission;
        if (through > 0.0) {
            const double inner = std::sqrt(std::max((ior_ - 1.0) * (ior_ + 1.0) + c * c, 0.0));
            reached = through * fit_.evaluate_rows(coefficients_, std::min(inner / ior_, 1.0));
        }
        reached.head(unscattered_.sources()) += unscattered_.at(1.0, c * c).from_above;
        return reached.cwiseMax(0.0).cwiseProduct(correction_);
    }

private:
    /// Integrates what reaches the sources over q in air, as the cells have it.
    Eigen::VectorXd integral_of_cells(const AngularGrid& grid,
                                      const Eigen::MatrixXd& from_cells) const {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(from_cells.rows());
        integrate_grazing(edges_in_air(grid), {1.0}, [&](double q, double w) {
            const RayResponse above = smooth_.at(1.0, 1.0 - q);
            sum.head(smooth_.sources()) += w * above.from_above;
            if (const int cell = cell_at(grid, q); cell >= 0)
                sum += w * above.transmission * from_cells.col(cell);
        });
        return sum;
    }

    /// Changes what is fitted by the last parts in 1e4, so that nothing is lost or gained.
    void correct_integral(const Eigen::VectorXd& whole) {
        correction_ = Eigen::VectorXd::Ones(whole.size());
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(whole.size());
        for (std::size_t piece = 0; piece + 1 < breaks_.size(); ++piece) {
            const double scale = std::numbers::pi * (breaks_[piece + 1] - breaks_[piece]);
            for_sin2_nodes(breaks_[piece], breaks_[piece + 1], SourceTransport::escape_nodes,
                           [&](double c, double weight) { sum += scale * weight * c * at(c); });
        }
        for (Eigen::Index source = 0; source < whole.size(); ++source)
            if (sum(source) > 0.0)
                correction_(source) = whole(source) / sum(source);
    }

    std::vector<double> edges_in_air(const AngularGrid& grid) const {
        std::vector<double> edges = grid.invariants();
        edges.push_back(0.0);
        for (const double n : smooth_.media())
            edges.push_back(n * n);
        std::erase_if(edges, [](double q) { return q > 1.0; });
        return edges;
    }

    /// Takes from the values on cells their means of what is known in closed form.
    void subtract_unscattered(const AngularGrid& grid, Eigen::MatrixXd& from_cells) const {
        const Eigen::Index known = unscattered_.sources(), top = smooth_.sources();
        const Eigen::VectorXd etendue = grid.etendue();
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(known, grid.cells());
        Eigen::VectorXd weight = Eigen::VectorXd::Zero(grid.cells());
        integrate_invariant(edges_in_air(grid), [&](double q, double w) {
            const int cell = cell_at(grid, q);
            const RayResponse above = smooth_.at(1.0, 1.0 - q);
            if (cell < 0 || !(above.transmission > 0.0))
                return;
            Eigen::VectorXd own = unscattered_.at(1.0, 1.0 - q).from_above;
            own.head(top) -= above.from_above;
            sum.col(cell) += w / above.transmission * own;
            weight(cell) += w;
        });
        for (Eigen::Index cell = 0; cell < grid.cells(); ++cell)
            if (weight(cell) > 0.0)
                from_cells.col(cell).head(known) -= sum.col(cell) / weight(cell);
    }

    std::vector<double> breaks_; ///< pieces of a quadrature over the cosine in air
    RayStack smooth_;            ///< to the first scatterer
    RayStack unscattered_;       ///< to the first rough interface
    double ior_;
    CellFit fit_;
    Eigen::MatrixXd coefficients_; ///< (sources, coefficients)
    Eigen::VectorXd correction_;   ///< by source
};

/// The parts of a stack: piles, and scatterers between them, from the air down.
class Sections {
public:
    Sections(const StackElements& stack, const StackCells& cells) {
        auto slab_cells = cells.begin();
        double ior = 1.0;
        std::optional<AngularGrid> above;
        std::vector<DepthCells> run_cells;
        std::size_t first = 0;
        const auto add_pile = [&](std::size_t end, const AngularGrid* below) {
            const RayStack rays(ior, std::span(stack).subspan(first, end - first), run_cells);
            add(pile_section(rays, above ? &*above : nullptr, below), rays.weights());
            run_cells.clear();
        };
        for (std::size_t k = 0; k < stack.size(); ++k) {
            const auto* slab = std::get_if<SlabValues>(&stack[k]);
            if (!scatters(stack[k])) {
                if (slab)
                    run_cells.push_back(*slab_cells++);
                continue;
            }
            AngularGrid upper;
            if (slab) {
                upper = slab_grid(*slab);
                add_pile(k, &upper);
                add_slab(*slab, upper, *slab_cells++);
                above = upper;
            } else {
                Scatterer rough = scatterer_of(std::get<SurfaceValues>(stack[k]));
                upper = rough.upper;
                add_pile(k, &upper);
                add(scatterer_section(rough), Eigen::VectorXd());
                above = std::move(rough.lower);
            }
            if (first == 0)
                first_grid = upper;
            ior = above->ior;
            first = k + 1;
        }
        last_grid = *above;
        add_pile(stack.size(), nullptr);
    }

    const std::vector<FluxSection>& parts() const { return parts_; }
    const Eigen::VectorXd& weights() const { return weights_; }

    AngularGrid first_grid, last_grid;

private:
    void add(FluxSection section, const Eigen::VectorXd& weights) {
        parts_.push_back(std::move(section));
        const Eigen::Index before = weights_.size();
        weights_.conservativeResize(before + weights.size());
        weights_.tail(weights.size()) = weights;
    }
    void add_slab(const SlabValues& slab, const AngularGrid& grid, const DepthCells& cells) {
        if (cells.count() == 0)
            add(scatterer_section(scatterer_of(slab)), Eigen::VectorXd());
        else
            add(DyedSlabSections(slab, grid, cells).whole(),
                Eigen::VectorXd::Constant(cells.count(), 4.0 * slab.ior * slab.ior));
    }

    std::vector<FluxSection> parts_;
    Eigen::VectorXd weights_;
};

class AngularSources final : public SourceTransport {
public:
    AngularSources(const StackElements& stack, const StackCells& cells)
        : breaks_(reradiant::breaks_in_air(stack)) {
        const Sections sections(stack, cells);
        const std::vector<FluxSection>& parts = sections.parts();
        FluxSection upper = parts.front(), lower = parts.back();
        for (std::size_t k = 1; k + 1 < parts.size(); ++k)
            upper = section_above(upper, parts[k]);
        for (std::size_t k = parts.size() - 2; k > 0; --k)
            lower = section_above(parts[k], lower);
        const FluxSection whole = section_above(upper, parts.back());
        weights_ = sections.weights();
        exchange_ = whole.between * weights_.cwiseInverse().asDiagonal();
        guided_ = whole.guided.cwiseQuotient(weights_);
        above_.emplace(stack, cells, sections.first_grid, from_between_down(parts.front(), lower));
        if (!std::holds_alternative<DiffuseValues>(stack.back()))
            below_.emplace(upside_down(stack), StackCells(cells.rbegin(), cells.rend()),
                           sections.last_grid,
                           from_between_up(upper, parts.back()).colwise().reverse());
    }

    Eigen::VectorXd reached(double cos_theta, Side from) const override {
        if (from == Side::Above)
            return above_->at(cos_theta);
        return below_->at(cos_theta).reverse();
    }

protected:
    Eigen::VectorXd integrate_escaped(Side to) const override {
        return escaped_by_reciprocity(breaks_, to);
    }

private:
    std::vector<double> breaks_;
    std::optional<ReachedFromAir> above_, below_;
};

} // namespace

std::shared_ptr<const SourceTransport> angular_sources(const StackElements& stack,
                                                       const StackCells& cells) {
    return std::make_shared<AngularSources>(stack, cells);
}

} // namespace reradiant
