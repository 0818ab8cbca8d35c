#pragma once

#include "host/layers/stack/substrate_values.h"
#include "reradiant/layer_stack.h"
#include "reradiant/reradiation.h"
#include "reradiant/wavelength_grid.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

/// Slabs that absorb, scatter and fluoresce, and what an independent random walk says of them.
namespace reradiant::test {

inline const WavelengthGrid three_bands{400.0, 50.0, 3};

/// A spectrum by its values at the three bands.
inline Spectrum at_three_bands(const std::vector<double>& values) {
    return Spectrum::table(three_bands.centres_nm(), values);
}

inline Eigen::MatrixXd matrix_of_three(const std::vector<double>& row_major) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major.data());
}

/// Absorbs with these optical depths in a slab of thickness 1 and sends out these shares, rows =
/// emission, of the power that it absorbs.
inline SlabDye dye_of_three(const std::vector<double>& depths, const Eigen::MatrixXd& shares) {
    ReradiationMatrix matrix{three_bands, three_bands, shares};
    return {.absorption = at_three_bands(depths),
            .emission = {},
            .shares = std::make_shared<const ReradiationMatrix>(matrix)};
}

/// Hemispherical values, rows = emission, with their standard errors.
struct SlabTruth {
    std::vector<double> values, errors;

    Eigen::MatrixXd value() const { return matrix_of_three(values); }
    Eigen::MatrixXd error() const { return matrix_of_three(errors); }
};

struct SlabCase {
    const char* name;
    LayerStack stack;
    Eigen::MatrixXd substrate; ///< Lambertian; of sheets without meaning
    double theta_i_deg;
    SlabTruth reflected, transmitted;
};

inline Layer dyed_layer(double ior, const std::vector<double>& depths,
                        const std::vector<double>& shares) {
    Layer layer;
    layer.ior = Spectrum::constant(ior);
    layer.dyes = {dye_of_three(depths, matrix_of_three(shares))};
    return layer;
}

/// The six open cases: sheets with and without index matching, over black and over a substrate
/// that fluoresces; clear, cloudy and rough with single scattering.
inline std::vector<SlabCase> slab_cases() {
    const std::vector<double> shares{0, 0, 0, .5, 0, 0, .2, .7, 0}, none(9, 0.0);
    const Eigen::MatrixXd black = Eigen::MatrixXd::Zero(3, 3);
    const LowerFace smooth;
    Layer tinted = dyed_layer(1.5, {.8, .2, 0}, shares);
    tinted.absorption = at_three_bands({.02, .01, .01});
    Layer milky = dyed_layer(1.4, {1, .3, .1}, {.05, 0, 0, .45, .2, 0, .2, .5, .3});
    milky.absorption = Spectrum::constant(.05);
    milky.scattering_coefficient = Spectrum::constant(5);
    milky.anisotropy = .5;
    Layer cloudy = dyed_layer(1.0, {1, .3, 0}, shares);
    cloudy.scattering_coefficient = Spectrum::constant(3);
    Layer rough = dyed_layer(1.5, {1, .4, 0}, shares);
    rough.alpha = .2;
    rough.scattering = Scattering::Single;
    rough.absorption = Spectrum::constant(.02);
    rough.scattering_coefficient = Spectrum::constant(2);
    rough.anisotropy = .3;
    return {
        {"clear sheet of n = 1",
         {{dyed_layer(1.0, {1.5, .4, 0}, shares)}, smooth},
         black,
         30,
         {{0, 0, 0, .1412212, 0, 0, .1385048, .1295177, 0},
          {0, 0, 0, 1.7e-4, 0, 0, 1.7e-4, 1.7e-4, 0}},
         {{.1770515, 0, 0, .11, .630206, 0, .1381223, .129585, 1},
          {1.9e-4, 0, 0, 1.6e-4, 2.4e-4, 0, 1.7e-4, 1.7e-4, 0}}},
        {"clear over black",
         {{dyed_layer(1.5, {2, .5, 0}, shares)}},
         black,
         0,
         {{.0400465, 0, 0, .03948325, .03994825, 0, .0389885, .0302685, .03986025},
          {9.8e-5, 0, 0, 9.7e-5, 9.8e-5, 0, 9.7e-5, 8.6e-5, 9.8e-5}},
         {none, none}},
        {"tinted over a fluorescent substrate",
         {{tinted}},
         matrix_of_three({.3, 0, 0, .3, .5, 0, .1, .3, .8}),
         45,
         {{.068326, 0, 0, .105111, .1860158, 0, .2451548, .3433005, .5996315},
          {1.3e-4, 0, 0, 1.5e-4, 1.9e-4, 0, 2.2e-4, 2.4e-4, 2.4e-4}},
         {none, none}},
        {"milky over black",
         {{milky}},
         black,
         0,
         {{.1241388, 0, 0, .101232, .2491762, 0, .08667175, .08614075, .3320918},
          {1.6e-4, 0, 0, 1.5e-4, 2.2e-4, 0, 1.4e-4, 1.4e-4, 2.4e-4}},
         {none, none}},
        {"cloudy sheet of n = 1",
         {{cloudy}, smooth},
         black,
         40,
         {{.2728603, 0, 0, .1599548, .4580002, 0, .1386195, .165133, .6743598},
          {2.2e-4, 0, 0, 1.8e-4, 2.5e-4, 0, 1.7e-4, 1.9e-4, 2.3e-4}},
         {{.03938375, 0, 0, .06252675, .1517253, 0, .08395625, .107917, .3256403},
          {9.7e-5, 0, 0, 1.2e-4, 1.8e-4, 0, 1.4e-4, 1.6e-4, 2.3e-4}}},
        {"rough cloudy sheet",
         {{rough}, LowerFace{.alpha = .2, .scattering = Scattering::Single}},
         black,
         30,
         {{.09318957, 0, 0, .07119965, .1503408, 0, .1214631, .1547815, .3392332},
          {2e-4, 0, 0, 1.8e-4, 2.5e-4, 0, 2.2e-4, 2.4e-4, 3.2e-4}},
         {{.07558585, 0, 0, .05215957, .1774771, 0, .1116164, .144291, .4220066},
          {1.8e-4, 0, 0, 1.5e-4, 2.7e-4, 0, 2.1e-4, 2.4e-4, 3.3e-4}}},
    };
}

} // namespace reradiant::test
