#include "host/layers/angular/angular_transport.h"

#include "host/layers/angular/angular_system.h"
#include "host/layers/models/adding.h"
#include "host/layers/models/returned_lobe.h"
#include "host/layers/rough/facet_shape.h"
#include "host/layers/rough/interface_walk.h"
#include "host/layers/rough/lost_flux.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/layers/stack/quadrature.h"
#include "host/layers/stack/stack_variants.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace reradiant {

namespace {

/// Fits are the same for all stacks with the same upper side of the first scatterer.
std::shared_ptr<const CellFit> fit_of(const AngularGrid& grid) {
    static std::mutex mutex;
    static std::map<double, std::shared_ptr<const CellFit>> known;
    const std::scoped_lock lock(mutex);
    auto& fit = known[grid.critical];
    if (!fit)
        fit = std::make_shared<CellFit>(grid);
    return fit;
}

/// A share as a function of the cosine above the first scatterer, fitted to its cells. Beneath a
/// slab's top it is exp(-d / c) p(c) + (1 - exp(-d / c)) s(c), d the slab's depth, p of what passes
/// unscattered, s of the rest: a thin slab's 1 / c is no polynomial, and a fit of it rings.
class ShareFit {
public:
    ShareFit() = default;
    ShareFit(std::shared_ptr<const CellFit> fit, const Eigen::VectorXd& share)
        : fit_(std::move(fit)), scattered_(fit_->coefficients(share)) {}
    ShareFit(std::shared_ptr<const CellFit> fit, const AngularGrid& grid, double depth,
             const Eigen::VectorXd& share, const Eigen::VectorXd& passed)
        : fit_(std::move(fit)), depth_(depth), passed_(fit_->coefficients(passed)) {
        Eigen::VectorXd rest(share.size());
        for (Eigen::Index j = 0; j < rest.size(); ++j) {
            // the mean of 1 / c over the cell's flux, as in the slab's operator
            const auto k = static_cast<std::size_t>(j);
            const double lost = -std::expm1(-2.0 * depth / (grid.edges[k] + grid.edges[k + 1]));
            rest(j) = passed(j) + (share(j) - passed(j)) / lost;
        }
        scattered_ = fit_->coefficients(rest);
    }

    double operator()(double c) const {
        const double rest = fit_->evaluate(scattered_, c);
        if (depth_ == 0.0)
            return rest;
        const double lost = c > 0.0 ? -std::expm1(-depth_ / c) : 1.0;
        const double passed = fit_->evaluate(passed_, c);
        return passed + lost * (rest - passed);
    }

private:
    std::shared_ptr<const CellFit> fit_;
    double depth_ = 0.0;
    Eigen::VectorXd passed_, scattered_;
};

class AngularTransport final : public AddingModel {
public:
    explicit AngularTransport(std::span<const StackElement> stack)
        : AddingModel(stack), stack_(stack.begin(), stack.end()),
          unscattered_(without_scattered(stack)), system_(stack), fit_(fit_of(system_.top_grid())),
          top_(system_.top()), top_rough_(top_.ior.size() == 1) {
        while (first_rough_ < stack_.size() && !is_rough(first_rough_))
            ++first_rough_;
        lobe_top_ = smooth_pile(1.0, std::span(unscattered_).first(first_rough_));
        const AngularResponse response = system_.solve();
        substrate_ = fitted(response, &AngularShares::to_substrate);
        air_ = fitted(response, &AngularShares::to_air);
        lost_ = fitted(response, &AngularShares::lost);
        air_cells_ = response.incoming.to_air;
        internal_reflectance_ = std::clamp(response.internal_reflectance, 0.0, 1.0);
        make_reciprocal(response.escape);
        make_lobes();
        residual_average_ =
            integrate_pieces(breaks_, 64, [this](double c) { return 2.0 * c * residual(c); });
    }

    double transmission(double c) const override { return shares(c).transmission; }
    double specular_albedo(double c) const override { return shares(c).specular; }
    double specular_delta(double c) const override {
        return smooth_response(lobe_top_, 1.0, std::clamp(c, 0.0, 1.0)).reflection_down;
    }
    bool has_top_lobe() const override { return top_rough_; }
    const std::vector<LobeShape>& deeper_lobes() const override { return lobes_; }
    double lobe_amplitude(int lobe, double c) const override {
        return tables_.at(static_cast<std::size_t>(lobe)).amplitude(c);
    }
    double residual(double c) const override {
        const double given_back = lost_flux_ ? lost_flux_->given_back(c) : 0.0;
        if (facets_are_all_) // a small difference of large shares would say less
            return given_back;
        double rest = specular_albedo(c) - specular_delta(c) - top_lobe_albedo(c);
        for (const LobeTables& table : tables_)
            rest -= table.albedo(c);
        return std::max(rest, given_back);
    }
    double residual_average() const override { return residual_average_; }
    std::vector<double> lobe_shares(double c) const override {
        std::vector<double> shares{top_lobe_albedo(c)};
        for (std::size_t l = 0; l < lobes_.size(); ++l) {
            const double share = tables_[l].albedo(c);
            shares.push_back(lobes_[l].is_between_facets() ? 0.0 : share);
            shares.front() += lobes_[l].is_between_facets() ? share : 0.0;
        }
        return shares;
    }
    double lost(double c) const override { return shares(c).lost; }

protected:
    double diffuse_reflectance() const override { return internal_reflectance_; }
    Eigen::MatrixXd returned_to_substrate(const CosineNodes& nodes) const override {
        return system_.returned(nodes);
    }
    std::shared_ptr<const SubstrateArrivals> arrivals() const override {
        return SubstrateArrivals::of(stack_);
    }

private:
    struct Shares {
        double transmission, specular, lost;
    };

    /// Returns the shares of light from a direction in air: through the smooth interfaces at the
    /// top exactly, then by the fitted functions of the cosine above the first scatterer.
    Shares shares(double cosine) const {
        const double c = std::clamp(cosine, 0.0, 1.0);
        const SmoothResponse in = smooth_response(top_, 1.0, c);
        if (in.transmission <= 0.0)
            return {0.0, in.reflection_down, 0.0};
        const double inside = inner_cosine(top_, c);
        const double raw = std::clamp(substrate_(inside), 0.0, 1.0);
        const double to_substrate = reciprocity_ * raw;
        // the correction moves light between the two, so that nothing is created
        // and the fits of shares whose sum is 1 miss it by up to 2e-9 (Beckmann 0.6 beneath a coat)
        const double to_air =
            std::clamp(air_(inside) + (raw - to_substrate), 0.0, std::max(1.0 - to_substrate, 0.0));
        const double lost = std::max(lost_(inside), 0.0);
        return {in.transmission * to_substrate, in.reflection_down + in.transmission * to_air,
                in.transmission * lost};
    }

    ShareFit fitted(const AngularResponse& response, Eigen::VectorXd AngularShares::*share) const {
        return system_.top_depth() > 0.0
                   ? ShareFit(fit_, system_.top_grid(), system_.top_depth(),
                              response.incoming.*share, response.passed.*share)
                   : ShareFit(fit_, response.incoming.*share);
    }

    static double inner_cosine(const SmoothStack& media, double c) {
        const double n = media.ior.back();
        const double g2 = (n - 1.0) * (n + 1.0) + c * c;
        return g2 > 0.0 ? std::min(std::sqrt(g2) / n, 1.0) : 0.0;
    }

    /// Scales the transmission by the last parts in 1e4, so that 2 integral c T dc is n_k^2 times
    /// the flux that the substrate sends out: an albedo of 1 stays 1 to rounding.
    void make_reciprocal(double escape) {
        std::vector<double> inner;
        for (const double n : top_.ior)
            inner.push_back(std::sqrt(std::fabs((n - 1.0) * (n + 1.0))));
        const AngularGrid& grid = system_.top_grid();
        if (grid.critical > 0.0) {
            const double n = top_.ior.back();
            const double c2 = 1.0 - n * n * (1.0 - grid.critical) * (1.0 + grid.critical);
            inner.push_back(std::sqrt(std::max(c2, 0.0)));
        }
        breaks_ = breaks_between_0_and_1(inner);
        const double integral = integrate_pieces(
            breaks_, 64, [this](double c) { return 2.0 * c * shares(c).transmission; });
        const double n = lowest_ior();
        if (integral > 0.0)
            reciprocity_ = n * n * escape / integral;
    }

    double top_lobe_albedo(double c) const {
        return top_rough_ ? std::max(fit_->evaluate(top_lobe_, c), 0.0) : 0.0;
    }

    /// First reflection lobe at the top, then one lobe for each deeper rough interface and for
    /// each run of smooth interfaces beneath a rough one. They hold light that no slab scattered.
    void make_lobes() {
        if (first_rough_ == stack_.size())
            return;
        std::vector<std::size_t> interfaces; // from the first rough one on
        for (std::size_t e = first_rough_; e < stack_.size(); ++e)
            if (std::holds_alternative<SurfaceValues>(stack_[e]))
                interfaces.push_back(e);
        const std::size_t count = interfaces.size();
        const auto cut_system = [&](std::size_t k) { // black beneath so many of them
            const std::size_t end = k < count ? interfaces[k] : stack_.size();
            return AngularSystem(std::span(unscattered_).first(end));
        };
        const AngularGrid grid = cut_system(1).top_grid();
        lobe_fit_ = fit_of(grid);
        const auto cut_albedo = [&](std::size_t k) {
            const bool whole = k == count && unscattered_ == stack_;
            return lobe_fit_->coefficients(whole ? air_cells_
                                                 : cut_system(k).solve().incoming.to_air);
        };
        Eigen::VectorXd above = lobe_fit_->coefficients(Eigen::VectorXd::Zero(grid.cells()));
        std::size_t k = 0;
        if (top_rough_) {
            set_top_lobe();
            add_facet_lobe();
            ++k;
            if (k < count)
                above = cut_albedo(k);
        }
        while (k < count) {
            const std::size_t first = interfaces[k++];
            if (!is_rough(first))
                while (k < count && !is_rough(interfaces[k]))
                    ++k;
            const Eigen::VectorXd cut = cut_albedo(k);
            add_lobe(first, interfaces[k - 1], cut - above);
            above = cut;
        }
    }

    void set_top_lobe() {
        if (system_.first_lobe().size() > 0)
            top_lobe_ = fit_->coefficients(system_.first_lobe());
        else
            top_lobe_ = fit_->coefficients(inverted_first_lobe());
    }

    /// Adds the lobe of the light that the top interface's facets scatter more than once; light
    /// that has no shape of its own is left to the residual.
    void add_facet_lobe() {
        const SurfaceValues& top = std::get<SurfaceValues>(stack_.front());
        if (system_.between_facets().size() == 0)
            return;
        facets_are_all_ = std::none_of(stack_.begin() + 1, stack_.end(), interacts);
        if (top.distribution == Distribution::Blinn && top.scattering == Scattering::Multiple)
            lost_flux_ = LostFlux::of(std::round(top.ior_below * 100.0) / 100.0, top.alpha);
        LobeShape lobe{Distribution::Ggx, top.alpha,
                       facet_shape({top.ior_below, top.distribution, top.alpha, top.scattering})};
        if (!lobe.table)
            return;
        const Eigen::VectorXd albedo = fit_->coefficients(system_.between_facets());
        lobes_.push_back(lobe);
        tables_.push_back(fit_lobe(lobe, [&](double c) { return fit_->evaluate(albedo, c); }));
    }

    /// Albedo of the top lobe towards a thinner medium, by quadrature over facets.
    Eigen::VectorXd inverted_first_lobe() const {
        const SurfaceValues& top = std::get<SurfaceValues>(stack_.front());
        const AngularGrid& grid = system_.top_grid();
        const RoughInterface interface {
            1.0 / top.ior_below, top.distribution, top.alpha, Scattering::Single
        };
        Eigen::VectorXd albedo = Eigen::VectorXd::Zero(grid.cells());
        const LatticeRule rule = lattice_rule(interface);
        std::vector<Departure> departures;
        for (int cell = 0; cell < grid.cells(); ++cell) {
            const double low = grid.edges[static_cast<std::size_t>(cell)];
            const double high = grid.edges[static_cast<std::size_t>(cell) + 1];
            const WalkStream stream(rule, static_cast<unsigned>(cell));
            for (unsigned walk = 0; walk < rule.count; ++walk) {
                WalkNumbers numbers(stream, walk);
                const double c =
                    std::sqrt(low * low + (high - low) * (high + low) * numbers.next());
                departures.clear();
                albedo(cell) +=
                    scatter_at_interface(interface, true, std::min(c, 1.0), numbers, departures) /
                    rule.count;
            }
        }
        return albedo;
    }

    /// True for what reflects or scatters light that came through the top interface.
    static bool interacts(const StackElement& element) {
        const auto* slab = std::get_if<SlabValues>(&element);
        return slab ? slab->tau_scattering > 0.0 : true;
    }

    /// True for a rough interface; slabs do not make lobes.
    bool is_rough(std::size_t element) const {
        const auto* surface = std::get_if<SurfaceValues>(&stack_[element]);
        return surface && surface->scatters();
    }

    /// The lobe of light whose deepest interface is one from `first` to `last`.
    void add_lobe(std::size_t first, std::size_t last, const Eigen::VectorXd& coefficients) {
        const LobeShape lobe = returned_lobe(unscattered_, first, last);
        lobes_.push_back(lobe);
        tables_.push_back(fit_lobe(lobe, [&](double c) {
            const double in = smooth_response(lobe_top_, 1.0, c).transmission;
            return in > 0.0 ? in * lobe_fit_->evaluate(coefficients, inner_cosine(lobe_top_, c))
                            : 0.0;
        }));
    }

    StackElements stack_, unscattered_;
    AngularSystem system_;
    std::shared_ptr<const CellFit> fit_, lobe_fit_;
    SmoothStack top_;             ///< to the first scatterer
    SmoothStack lobe_top_;        ///< to the first rough interface, for what is not scattered
    std::size_t first_rough_ = 0; ///< element of an interface, or the number of elements
    bool top_rough_ = false;
    /// Of V-cavities at the top; its IOR is rounded, so that a dispersive material needs few.
    std::shared_ptr<const LostFlux> lost_flux_;
    bool facets_are_all_ = false; ///< nothing but the top interface sends light back
    double reciprocity_ = 1.0;
    double internal_reflectance_ = 0.0, residual_average_ = 0.0;
    ShareFit substrate_, air_, lost_;
    Eigen::VectorXd air_cells_, top_lobe_;
    std::vector<double> breaks_;
    std::vector<LobeShape> lobes_;
    std::vector<LobeTables> tables_;
};

} // namespace

std::shared_ptr<const AddingModel> angular_transport(std::span<const StackElement> stack) {
    return std::make_shared<AngularTransport>(stack);
}

} // namespace reradiant
