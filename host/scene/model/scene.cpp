#include "reradiant/scene.h"

#include "reradiant/reradiation.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reradiant {

namespace {

/// Wavelengths looked at where a spectrum itself has no end (constants, tables outside their
/// data): beyond them no source, detector or dye of this field works.
constexpr int SEARCH_FROM_NM = 200, SEARCH_TO_NM = 1200;

/// Lowest and highest wavelength where the spectrum is not zero, to 1 nm; {0, 0} if none.
std::array<double, 2> support_nm(const Spectrum& spectrum) {
    const auto lit = [&](int nm) { return !spectrum.is_zero_within(nm, nm + 1.0); };
    int from = SEARCH_FROM_NM;
    while (from < SEARCH_TO_NM && !lit(from))
        ++from;
    if (from == SEARCH_TO_NM)
        return {0.0, 0.0};
    int to = SEARCH_TO_NM;
    while (!lit(to - 1))
        --to;
    return {static_cast<double>(from), static_cast<double>(to)};
}

struct Ranges {
    std::array<double, 2> excitation{}, emission{};
};

void widen(std::array<double, 2>& range, double from_nm, double to_nm) {
    const bool empty = range[1] <= range[0];
    range = {empty ? from_nm : std::min(range[0], from_nm),
             empty ? to_nm : std::max(range[1], to_nm)};
}

Ranges ranges_of_matrix(const ReradiationMatrix& matrix) {
    Ranges ranges;
    const Eigen::MatrixXd fluorescence = matrix.fluorescent_part();
    for (int i = 0; i < matrix.excitation.count; ++i)
        if (fluorescence.col(i).maxCoeff() > 0.0)
            widen(ranges.excitation, matrix.excitation.lower_edge_nm(i),
                  matrix.excitation.upper_edge_nm(i));
    for (int o = 0; o < matrix.emission.count; ++o)
        if (fluorescence.row(o).maxCoeff() > 0.0)
            widen(ranges.emission, matrix.emission.lower_edge_nm(o),
                  matrix.emission.upper_edge_nm(o));
    return ranges;
}

/// A fluorophore emits only above the wavelength that it absorbs.
Ranges ranges_of_fluorophores(const std::vector<Fluorophore>& fluorophores) {
    Ranges ranges;
    for (const Fluorophore& fluorophore : fluorophores) {
        const auto excitation = support_nm(fluorophore.excitation);
        const auto emission = support_nm(fluorophore.emission);
        if (fluorophore.quantum_yield <= 0.0 || excitation[1] <= 0.0 ||
            excitation[0] >= emission[1])
            continue;
        widen(ranges.excitation, excitation[0], std::min(excitation[1], emission[1]));
        widen(ranges.emission, std::max(emission[0], excitation[0]), emission[1]);
    }
    return ranges;
}

Ranges ranges_of(const Substrate& substrate) {
    return substrate.matrix ? ranges_of_matrix(*substrate.matrix)
                            : ranges_of_fluorophores(substrate.fluorophores);
}

} // namespace

const Spectrum& light_spectrum(const Light& light) {
    struct Visitor {
        const Spectrum& operator()(const RectangleLight& l) const { return l.radiance; }
        const Spectrum& operator()(const SphereLight& l) const { return l.radiance; }
        const Spectrum& operator()(const PointLight& l) const { return l.intensity; }
        const Spectrum& operator()(const DirectionalLight& l) const { return l.irradiance; }
        const Spectrum& operator()(const EnvironmentLight& l) const { return l.radiance; }
    };
    return std::visit(Visitor{}, light);
}

bool Substrate::is_fluorescent() const {
    return ranges_of(*this).excitation[1] > 0.0;
}

std::optional<WavelengthGrid> Substrate::own_grid() const {
    if (!matrix)
        return std::nullopt;
    const WavelengthGrid& emission = matrix->emission;
    const WavelengthGrid& excitation = matrix->excitation;
    const double step = emission.step_nm;
    const double offset = (excitation.from_nm - emission.from_nm) / step;
    if (std::fabs(excitation.step_nm - step) > 1e-6 * step ||
        std::fabs(offset - std::round(offset)) > 1e-6)
        return std::nullopt;
    const double from = std::min(emission.from_nm, excitation.from_nm);
    const double to = std::max(emission.to_nm(), excitation.to_nm());
    return WavelengthGrid{from, step, static_cast<int>(std::lround((to - from) / step)) + 1};
}

std::array<double, 2> Substrate::excitation_range_nm() const {
    return ranges_of(*this).excitation;
}

std::array<double, 2> Substrate::emission_range_nm() const {
    return ranges_of(*this).emission;
}

Model model_from_name(const std::string& name) {
    for (const Model model : {Model::Auto, Model::Adding, Model::WeidlichWilkie, Model::Walk})
        if (name == model_name(model))
            return model;
    throw std::invalid_argument("no model is called \"" + name +
                                "\"; use auto, adding, weidlich-wilkie or walk");
}

const char* model_name(Model model) {
    switch (model) {
    case Model::Adding:
        return "adding";
    case Model::WeidlichWilkie:
        return "weidlich-wilkie";
    case Model::Walk:
        return "walk";
    default:
        return "auto";
    }
}

} // namespace reradiant
