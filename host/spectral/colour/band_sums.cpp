#include "host/spectral/colour/band_sums.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace reradiant {

namespace {

/// Calls visit(band, share) with Lagrange's coefficients of the bands around a wavelength.
void interpolate(const WavelengthGrid& grid, double nm,
                 const std::function<void(int, double)>& visit) {
    const double position = (nm - grid.from_nm) / grid.step_nm;
    if (position <= 0.0 || position >= grid.count - 1) {
        visit(position <= 0.0 ? 0 : grid.count - 1, 1.0);
        return;
    }
    const int interval = static_cast<int>(position);
    const int first = std::max(0, interval - 1), last = std::min(grid.count - 1, interval + 2);
    for (int band = first; band <= last; ++band) {
        double share = 1.0;
        for (int other = first; other <= last; ++other)
            if (other != band)
                share *= (position - other) / (band - other);
        visit(band, share);
    }
}

/// Nodes that lie closer than 1e-4 nm are the two sides of a step.
bool is_finer_than_1_nm(const Spectrum& smooth) {
    constexpr double step_nm = 1e-4, rounding_nm = 1e-3;
    const std::vector<double> nodes = smooth.breakpoints_nm();
    for (std::size_t k = 1; k < nodes.size(); ++k)
        if (nodes[k] - nodes[k - 1] > step_nm && nodes[k] - nodes[k - 1] < 1.0 - rounding_nm)
            return true;
    return false;
}

/// The standard's ends count in full.
constexpr double whole_end_nm = 0.25;

Eigen::Vector3d vector_of(const Xyz& xyz) {
    return {xyz[0], xyz[1], xyz[2]};
}

} // namespace

Eye::Eye(Observer observer)
    : nodes_(colour_matching(observer).wavelengths_nm),
      curves_{Spectrum::table(nodes_, colour_matching(observer).x),
              Spectrum::table(nodes_, colour_matching(observer).y),
              Spectrum::table(nodes_, colour_matching(observer).z)} {}

Xyz Eye::operator()(double nm) const {
    if (nm < nodes_.front() || nm > nodes_.back())
        return {};
    return {curves_[0](nm), curves_[1](nm), curves_[2](nm)};
}

void add(Xyz& sum, const Xyz& term, double factor) {
    for (std::size_t c = 0; c < 3; ++c)
        sum[c] += factor * term[c];
}

LampAtNanometres::LampAtNanometres(const Spectrum& lamp)
    : lamp_(lamp), smooth_(lamp.without_lines()), is_fine_(is_finer_than_1_nm(smooth_)) {}

double LampAtNanometres::operator()(double nm) const {
    if (is_fine_)
        return lamp_.average(nm - 0.5, nm + 0.5);
    double light = smooth_(nm);
    for (const SpectralLine& line : lamp_.lines())
        light += Spectrum::line(line.centre_nm, line.width_nm, line.integral)
                     .average(nm - 0.5, nm + 0.5);
    return light;
}

Eigen::VectorXd irradiance_of(const WavelengthGrid& bands, const Viewing& viewing,
                              bool at_nanometres) {
    const auto excites = [&](double nm) { return nm >= viewing.excites_from_nm; };
    Eigen::VectorXd irradiance = Eigen::VectorXd::Zero(bands.count);
    if (!at_nanometres) {
        for (int i = 0; i < bands.count; ++i)
            if (excites(bands.centre_nm(i)))
                irradiance[i] = viewing.lamp(bands.centre_nm(i));
        return irradiance;
    }
    const double from = bands.lower_edge_nm(0), width = bands.count * bands.step_nm;
    const int pieces = std::max(bands.count, static_cast<int>(std::lround(width)));
    const double piece_nm = width / pieces;
    const LampAtNanometres lamp(viewing.lamp);
    for (int piece = 0; piece < pieces; ++piece) {
        const double nm = from + (piece + 0.5) * piece_nm;
        if (!excites(nm))
            continue;
        const double light = lamp(nm) * piece_nm / bands.step_nm;
        interpolate(bands, nm, [&](int band, double share) { irradiance[band] += share * light; });
    }
    return irradiance;
}

std::vector<double> lights_of(const WavelengthGrid& bands, const Spectrum& illuminant,
                              bool at_nanometres) {
    std::vector<double> lights = illuminant.at(bands.centres_nm());
    if (at_nanometres)
        for (int o = 0; o < bands.count; ++o)
            lights[static_cast<std::size_t>(o)] =
                illuminant.average(bands.lower_edge_nm(o), bands.upper_edge_nm(o));
    return lights;
}

SumRange sum_range(const WavelengthGrid& bands, ColourSum sum, bool at_nanometres) {
    if (!at_nanometres)
        return SumRange::Bands;
    return sum == ColourSum::E308 || reaches_far_enough(bands) ? SumRange::E308
                                                               : SumRange::WithinBands;
}

BandSums::BandSums(const WavelengthGrid& emission, const WavelengthGrid& excitation,
                   const Viewing& viewing, SumRange range)
    : irradiance_(irradiance_of(excitation, viewing, range != SumRange::Bands)),
      reflected_(Eigen::Matrix3Xd::Zero(3, emission.count)), luminescent_(reflected_) {
    switch (range) {
    case SumRange::Bands:
        add_bands(emission, viewing);
        break;
    case SumRange::WithinBands:
        add_nanometres(emission, viewing, emission.lower_edge_nm(0),
                       emission.upper_edge_nm(emission.count - 1));
        break;
    case SumRange::E308:
        add_nanometres(emission, viewing, e308_from_nm - whole_end_nm, e308_to_nm + whole_end_nm);
        break;
    }
}

void BandSums::add_bands(const WavelengthGrid& bands, const Viewing& viewing) {
    for (int o = 0; o < bands.count; ++o) {
        const double nm = bands.centre_nm(o), light = viewing.weights(nm);
        const double glow = viewing.luminescent_weight(viewing.lamp(nm), light);
        const Xyz eye = viewing.eye(nm);
        reflected_.col(o) = bands.step_nm * light * vector_of(eye);
        luminescent_.col(o) = bands.step_nm * glow * vector_of(eye);
        add(white_, eye, bands.step_nm * light);
    }
}

/// Whole nanometres, those at the very ends by half.
void BandSums::add_nanometres(const WavelengthGrid& bands, const Viewing& viewing, double from_nm,
                              double to_nm) {
    const LampAtNanometres weights(viewing.weights), lamp(viewing.lamp);
    for (double nm = std::ceil(from_nm); nm <= to_nm; nm += 1.0) {
        const double half = nm == from_nm || nm == to_nm ? 0.5 : 1.0;
        const double weight = weights(nm), light = half * weight;
        const double glow = half * viewing.luminescent_weight(lamp(nm), weight);
        const Xyz eye = viewing.eye(nm);
        interpolate(bands, nm, [&](int o, double share) {
            reflected_.col(o) += share * light * vector_of(eye);
            luminescent_.col(o) += share * glow * vector_of(eye);
        });
        add(white_, eye, light);
    }
}

Exitance BandSums::exitance_of(const ReradiationMatrix& matrix) const {
    const Spectrum reflectance = matrix.reflectance();
    Exitance exitance;
    exitance.reflectance.resize(matrix.emission.count);
    for (int o = 0; o < matrix.emission.count; ++o)
        exitance.reflectance[o] = reflectance(matrix.emission.centre_nm(o));
    exitance.luminescent = matrix.fluorescent_part() * irradiance_;
    return exitance;
}

Sums BandSums::sums_of(const Exitance& exitance) const {
    const Eigen::Vector3d reflected = reflected_ * exitance.reflectance,
                          luminescent = luminescent_ * exitance.luminescent;
    return {{reflected[0], reflected[1], reflected[2]},
            {luminescent[0], luminescent[1], luminescent[2]},
            white_};
}

bool reaches_far_enough(const WavelengthGrid& bands) {
    return bands.from_nm < 400.5 && bands.to_nm() > 699.5;
}

} // namespace reradiant
