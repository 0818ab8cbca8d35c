#include "reradiant/wavelength_plan.h"

#include "host/layers/stack/slab_emission.h"
#include "host/scene/model/fluorescence_ranges.h"
#include "host/scene/model/matrix_grids.h"
#include "host/scene/model/substrate.h"
#include "kernels/core/features.h"
#include "reradiant/reradiation.h"

#include <Eigen/Core>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reradiant {

namespace {

constexpr double widest_phase_nm = 1.25;
constexpr int most_phases = 512;
/// Lines up to this many comb steps wide get lanes of their own.
constexpr double widest_line_in_steps = 2.0;
constexpr std::size_t most_line_lanes = 32;

double step_tolerance(double step_nm) {
    return 1e-6 * step_nm;
}

/// Marks the cells that something excited in marked ones re-radiates to; whether any was new.
bool mark_re_radiated(const Eigen::MatrixXd& matrix, std::vector<bool>& active) {
    bool any = false;
    for (Eigen::Index i = 0; i < matrix.cols(); ++i)
        for (Eigen::Index o = 0; active[static_cast<std::size_t>(i)] && o < matrix.rows(); ++o)
            if (matrix(o, i) > 0.0 && !active[static_cast<std::size_t>(o)])
                any = active[static_cast<std::size_t>(o)] = true;
    return any;
}

/// Returns which cells can carry light at all: those a lamp emits in, and those that something
/// excited there can re-radiate to, in as many steps as it takes: by one material and then another,
/// or by one that emits at shorter wavelengths, too.
std::vector<bool> active_cells(const Scene& scene, const WavelengthGrid& cells) {
    const auto count = static_cast<std::size_t>(cells.count);
    std::vector<bool> active(count, false);
    for (int c = 0; c < cells.count; ++c)
        for (const Light& light : scene.lights)
            if (!light_spectrum(light).is_zero_within(cells.lower_edge_nm(c),
                                                      cells.upper_edge_nm(c)))
                active[static_cast<std::size_t>(c)] = true;
    std::vector<Eigen::MatrixXd> matrices;
    for (const Material& material : scene.materials) {
        if (material.substrate.is_fluorescent())
            matrices.push_back(fluorescence_of(material.substrate, cells));
        for (Eigen::MatrixXd& dyes : slab_emissions(material.stack, cells))
            if (dyes.size() > 0)
                matrices.push_back(std::move(dyes));
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (const Eigen::MatrixXd& matrix : matrices)
            changed = mark_re_radiated(matrix, active) || changed;
    }
    return active;
}

/// Returns true when some light is emitted below the wavelength that excites it.
bool has_anti_stokes_emission(const ReradiationMatrix* pointer) {
    const ReradiationMatrix& matrix = *pointer;
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o)
            if (fluorescence(o, i) > 0.0 &&
                matrix.emission.centre_nm(o) < matrix.excitation.centre_nm(i))
                return true;
    return false;
}

/// Whole steps from an edge of the film to a wavelength beyond it.
int steps_beyond(double gap_nm, double step_nm) {
    return std::max(0, static_cast<int>(std::ceil((gap_nm - step_tolerance(step_nm)) / step_nm)));
}

/// The film's cells, with whole steps added below as far as something can be excited, and above as
/// far as something that emits at shorter wavelengths can be.
WavelengthGrid cells_with_excitation(const Scene& scene, const WavelengthGrid& film) {
    const double from = film.lower_edge_nm(0), to = film.upper_edge_nm(film.count - 1);
    double lowest = from, highest = to;
    for (const Material& material : scene.materials) {
        const FluorescenceRanges ranges = fluorescence_ranges(material);
        if (ranges.is_empty())
            continue;
        lowest = std::min(lowest, ranges.excitation[0]);
        // fluorophores emit above what excites them only
        if (std::ranges::any_of(matrices_of(material), has_anti_stokes_emission))
            highest = std::max(highest, ranges.excitation[1]);
    }
    const int below = steps_beyond(from - lowest, film.step_nm),
              above = steps_beyond(highest - to, film.step_nm);
    return {film.from_nm - below * film.step_nm, film.step_nm, film.count + below + above};
}

/// Cells above the film can only matter by anti-Stokes emission; cells below it only by exciting.
WavelengthGrid trimmed(const Scene& scene, const WavelengthGrid& cells,
                       std::vector<std::string>& left_out) {
    const std::vector<bool> active = active_cells(scene, cells);
    int first = 0, last = cells.count - 1;
    while (first < last && !active[static_cast<std::size_t>(first)])
        ++first;
    while (last > first && !active[static_cast<std::size_t>(last)])
        --last;
    if (first > 0)
        left_out.push_back(fmt::format(
            "{} band(s) from {:g} to {:g} nm: no light emits there and nothing re-radiates there",
            first, cells.centre_nm(0), cells.centre_nm(first - 1)));
    if (last < cells.count - 1)
        left_out.push_back(fmt::format(
            "{} band(s) from {:g} to {:g} nm: no light emits there and nothing re-radiates there",
            cells.count - 1 - last, cells.centre_nm(last + 1), cells.to_nm()));
    return {cells.centre_nm(first), cells.step_nm, last - first + 1};
}

/// `count` equal cells over the same range.
WavelengthGrid recut(const WavelengthGrid& cells, int count) {
    const double from = cells.lower_edge_nm(0);
    const double step = (cells.upper_edge_nm(cells.count - 1) - from) / count;
    return {from + 0.5 * step, step, count};
}

/// Sub-cells fine enough to resolve spectra, and never wider than a film band.
int phases_for(double step_nm, double film_step_nm) {
    const double widest = std::min(widest_phase_nm, film_step_nm);
    int phases = 1;
    while (phases < most_phases && step_nm / phases > widest * (1.0 + 1e-9))
        phases *= 2;
    return phases;
}

/// Edges of cells and of film bands inside an interval, with both of its ends, ascending.
std::vector<double> cuts(double from, double to, const WavelengthGrid& comb,
                         const WavelengthGrid& film) {
    std::vector<double> edges = {from, to};
    for (const WavelengthGrid* grid : {&comb, &film})
        for (int c = 0; c <= grid->count; ++c)
            if (grid->lower_edge_nm(c) > from && grid->lower_edge_nm(c) < to)
                edges.push_back(grid->lower_edge_nm(c));
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Lines of all lamps, cut at the edges of cells and bands, each piece once.
std::vector<Lane> line_lanes(const Scene& scene, const WavelengthGrid& comb,
                             const WavelengthGrid& film) {
    std::vector<Lane> lanes;
    for (const Light& light : scene.lights)
        for (const SpectralLine& line : light_spectrum(light).lines()) {
            if (line.width_nm > widest_line_in_steps * comb.step_nm)
                continue;
            const std::vector<double> edges =
                cuts(line.centre_nm - 0.5 * line.width_nm, line.centre_nm + 0.5 * line.width_nm,
                     comb, film);
            for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
                const double middle = 0.5 * (edges[i] + edges[i + 1]);
                const double width = edges[i + 1] - edges[i];
                const int cell = comb.band_of(middle);
                const bool known = std::any_of(lanes.begin(), lanes.end(), [&](const Lane& l) {
                    return l.line_nm == middle && l.line_width_nm == width;
                });
                if (cell >= 0 && width > 1e-9 * line.width_nm && !known)
                    lanes.push_back({cell, true, middle, width});
            }
        }
    if (lanes.size() > most_line_lanes)
        lanes.clear(); // too many to stand apart: they stay on the comb, by sub-cell means
    std::sort(lanes.begin(), lanes.end(),
              [](const Lane& a, const Lane& b) { return a.line_nm < b.line_nm; });
    return lanes;
}

} // namespace

int WavelengthPlan::padded_lanes() const {
    return (static_cast<int>(lanes.size()) + WIDTH - 1) / WIDTH * WIDTH;
}

std::array<double, 2> WavelengthPlan::interval_nm(int lane, int phase) const {
    const Lane& l = lanes[static_cast<std::size_t>(lane)];
    if (l.is_line)
        return {l.line_nm - 0.5 * l.line_width_nm, l.line_nm + 0.5 * l.line_width_nm};
    const double width = comb.step_nm / phases;
    const double from = comb.lower_edge_nm(l.cell) + phase * width;
    return {from, from + width};
}

double WavelengthPlan::wavelength_nm(int lane, int phase) const {
    const Lane& l = lanes[static_cast<std::size_t>(lane)];
    if (l.is_line)
        return l.line_nm;
    return comb.lower_edge_nm(l.cell) + (phase + 0.5) * comb.step_nm / phases;
}

WavelengthPlan::Deposit WavelengthPlan::deposit(int lane, int phase) const {
    const auto [from, to] = interval_nm(lane, phase);
    const bool is_line = lanes[static_cast<std::size_t>(lane)].is_line;
    const double whole = (is_line ? 1.0 : comb.step_nm) / film.step_nm;
    // The interval is no wider than a band, so it meets two at most.
    const double tolerance = 1e-6 * (to - from);
    const auto first =
        static_cast<int>(std::floor((from + tolerance - film.lower_edge_nm(0)) / film.step_nm));
    const double within_first =
        std::clamp((film.upper_edge_nm(first) - from) / (to - from), 0.0, 1.0);
    const bool both = within_first < 1.0 - 1e-6;
    if (first >= 0 && first < film.count)
        return {first, both ? whole * within_first : whole,
                both && first + 1 < film.count ? whole * (1.0 - within_first) : 0.0};
    if (first == -1 && both)
        return {0, whole * (1.0 - within_first), 0.0};
    return {};
}

bool WavelengthPlan::stands_apart(const SpectralLine& line) const {
    return std::any_of(lanes.begin(), lanes.end(), [&](const Lane& lane) {
        return lane.is_line && lane.line_width_nm <= line.width_nm * (1.0 + 1e-9) &&
               std::abs(lane.line_nm - line.centre_nm) < 0.5 * line.width_nm &&
               line.width_nm <= widest_line_in_steps * comb.step_nm;
    });
}

std::array<int, 2> WavelengthPlan::seen_lanes() const {
    int first = static_cast<int>(lanes.size()), last = -1;
    for (int lane = 0; lane < static_cast<int>(lanes.size()); ++lane)
        for (int phase = 0; phase < phases; ++phase)
            if (deposit(lane, phase).band >= 0) {
                first = std::min(first, lane);
                last = lane;
            }
    return last < 0 ? std::array<int, 2>{0, 1} : std::array<int, 2>{first, last - first + 1};
}

bool WavelengthPlan::deposits_are_fixed() const {
    for (int lane = 0; lane < static_cast<int>(lanes.size()); ++lane)
        for (int phase = 0; phase < phases; ++phase)
            if (deposit(lane, phase) != deposit(lane, 0) || deposit(lane, phase).next_weight != 0.0)
                return false;
    return true;
}

WavelengthGrid film_bands(const Scene& scene) {
    if (scene.film.bands)
        return *scene.film.bands;
    const bool fluoresces = std::any_of(scene.materials.begin(), scene.materials.end(),
                                        [](const Material& m) { return m.is_fluorescent(); });
    return fluoresces ? WavelengthGrid{300.0, 10.0, 49} : WavelengthGrid{380.0, 10.0, 41};
}

WavelengthPlan plan_wavelengths(const Scene& scene, const WavelengthGrid& film,
                                const WavelengthOptions& options) {
    WavelengthPlan plan;
    plan.film = film;
    plan.comb = cells_with_excitation(scene, film);
    if (!options.keep_all)
        plan.comb = trimmed(scene, plan.comb, plan.left_out);
    if (options.comb_count > 0)
        plan.comb = recut(plan.comb, options.comb_count);
    plan.hero = options.hero_count;
    plan.phases = options.centred ? 1 : phases_for(plan.comb.step_nm, film.step_nm);
    const std::vector<Lane> lines = line_lanes(scene, plan.comb, film);
    auto line = lines.begin();
    for (int c = 0; c < plan.comb.count; ++c) {
        plan.lanes.push_back({c});
        for (; line != lines.end() && line->cell == c; ++line)
            plan.lanes.push_back(*line);
    }
    return plan;
}

} // namespace reradiant
