// Dyed slabs by adding, as Markdown tables: the error of what they send out against the number of
// depth cells, and the processor seconds that a material of one and of three dyed slabs takes.
#include "host/layers/models/adding.h"
#include "host/layers/models/layered_bsdf.h"
#include "host/layers/stack/slab_emission.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

using namespace reradiant;

namespace {

const std::vector<double> cosines{1.0, 0.5};

/// The varnish of a preset with another amount of dye, over its ground or in air.
LayerStack varnish(double concentration) {
    LayerStack stack =
        load_material(spectra_directory() / "materials/fluorescent-varnish-on-white.toml").stack;
    stack.layers[0].dyes[0].concentration = concentration;
    return stack;
}

double largest_depth(const LayerStack& stack, const WavelengthGrid& bands) {
    double depth = 0.0;
    for (int band = 0; band < bands.count; ++band)
        for (const StackElement& element : stack_at(stack, bands.centre_nm(band)))
            if (const auto* slab = std::get_if<SlabValues>(&element))
                depth = std::max(depth, slab->depth());
    return depth;
}

/// What leaves above, (bands, excitations of all cosines), with uniform emission in every cell.
Eigen::MatrixXd sent_back(const LayerStack& stack, const WavelengthGrid& bands,
                          const StackCells& cells) {
    std::vector<std::shared_ptr<const SourceTransport>> by_band;
    for (int band = 0; band < bands.count; ++band)
        by_band.push_back(source_transport(stack_at(stack, bands.centre_nm(band)), cells));
    const ReEmission series(by_band, cells, slab_emissions(stack, bands), {});
    Eigen::MatrixXd leaving(bands.count, 0);
    for (const double cosine : cosines)
        for (int i = 0; i < bands.count; ++i) {
            const Eigen::MatrixXd sent = series.sent(i, series.at(i).reached(cosine, Side::Above));
            leaving.conservativeResize(Eigen::NoChange, leaving.cols() + 1);
            for (int o = 0; o < bands.count; ++o)
                leaving(o, leaving.cols() - 1) = series.at(o).escaped(Side::Above).dot(sent.col(o));
        }
    return leaving;
}

/// Errors at one, two, four... cells per octave: of uniform cells, and of two sizes extrapolated.
struct CellErrors {
    double depth;
    std::vector<int> cells;
    std::vector<double> uniform, extrapolated;
};

CellErrors cell_errors(double concentration) {
    constexpr int most = 32;
    const WavelengthGrid bands{410, 20, 8};
    LayerStack stack = varnish(concentration);
    stack.lower_face = LowerFace{};
    CellErrors found{largest_depth(stack, bands), {}, {}, {}};
    std::vector<Eigen::MatrixXd> values;
    for (int per_octave = 1; per_octave <= most; per_octave *= 2) {
        const DepthCells cells = depth_cells(found.depth, per_octave);
        found.cells.push_back(cells.count());
        values.push_back(sent_back(stack, bands, {cells}));
    }
    const auto extrapolated = [&](std::size_t k) {
        return Eigen::MatrixXd((4.0 * values[k] - values[k - 1]) / 3.0);
    };
    const Eigen::MatrixXd truth = extrapolated(values.size() - 1);
    const auto error = [&](const Eigen::MatrixXd& value) {
        return (value - truth).cwiseAbs().maxCoeff() / truth.maxCoeff();
    };
    for (std::size_t k = 0; k + 1 < values.size(); ++k) {
        found.uniform.push_back(error(values[k]));
        found.extrapolated.push_back(k > 0 ? error(extrapolated(k)) : NAN);
    }
    return found;
}

void print_errors() {
    std::vector<CellErrors> all;
    for (const double concentration : {0.1, 1.0, 10.0, 100.0})
        all.push_back(cell_errors(concentration));
    fmt::print(
        "## Error against depth cells\n\nA sheet of varnish with a dye, 8 bands: largest "
        "error of a directional-hemispherical share, of the largest.\n\n| cells per octave |");
    for (const CellErrors& one : all)
        fmt::print(" depth {:.1f}: cells, uniform, extrapolated |", one.depth);
    fmt::print("\n| --- | --- | --- | --- | --- |\n");
    for (std::size_t k = 0; k < all.front().uniform.size(); ++k) {
        fmt::print("| {} |", 1 << k);
        for (const CellErrors& one : all)
            fmt::print(" {}, {:.1e}, {} |", one.cells[k], one.uniform[k],
                       k > 0 ? fmt::format("{:.1e}", one.extrapolated[k]) : "-");
        fmt::print("\n");
    }
}

/// One dyed slab, or three of them with other indices and amounts of dye.
LayerStack dyed_slabs(int count, double alpha, double scattering) {
    LayerStack stack = varnish(1.0);
    stack.layers[0].alpha = alpha;
    stack.layers[0].scattering_coefficient = Spectrum::constant(scattering);
    const std::vector<double> iors{1.5, 1.4, 1.6}, concentrations{1.0, 0.3, 2.0};
    const Layer first = stack.layers[0];
    for (std::size_t k = 1; k < static_cast<std::size_t>(count); ++k) {
        stack.layers.push_back(first);
        stack.layers.back().alpha = 0.0;
        stack.layers.back().ior = Spectrum::constant(iors[k]);
        stack.layers.back().dyes[0].concentration = concentrations[k];
    }
    return stack;
}

std::string timed(const LayerStack& stack) {
    const WavelengthGrid bands{300, 10, 49};
    const SubstrateValues white{.matrix = 0.9 * Eigen::MatrixXd::Identity(49, 49)};
    const std::clock_t start = std::clock();
    const LayeredBsdf bsdf(stack, white, bands, adding_bsdf);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return fmt::format("{}, {:.1e}, {:.2g} s", bsdf.emitting()->cells(), bsdf.emitting()->error(),
                       seconds);
}

void print_seconds() {
    fmt::print("\n## Processor seconds\n\nAt 49 bands, over a white ground.\n\n"
               "| slabs | one dyed: cells, error, processor time | three dyed: the same |\n| --- | "
               "--- | --- |\n");
    struct Kind {
        const char* name;
        double alpha, scattering;
    };
    timed(dyed_slabs(1, 0.2, 0.0)); // makes the table of the rough interface
    for (const Kind& kind : {Kind{"smooth", 0.0, 0.0}, Kind{"rough at the top", 0.2, 0.0},
                             Kind{"cloudy (depth 1 each)", 0.0, 10.0}})
        fmt::print("| {} | {} | {} |\n", kind.name,
                   timed(dyed_slabs(1, kind.alpha, kind.scattering)),
                   timed(dyed_slabs(3, kind.alpha, kind.scattering)));
}

} // namespace

int main() {
    print_errors();
    std::fflush(stdout);
    print_seconds();
    return 0;
}
