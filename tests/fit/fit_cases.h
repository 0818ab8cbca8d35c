#pragma once

#include "reradiant/bispectral_data.h"
#include "reradiant/fit.h"
#include "reradiant/reradiation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace reradiant {

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// One synthetic fluorophore: Gaussian bands over wavelength.
struct TestFluorophore {
    double excitation_nm, excitation_sigma_nm, absorptance;
    double emission_nm, emission_sigma_nm, quantum_yield;
};

inline Fluorophore as_fluorophore(const TestFluorophore& f) {
    return {Spectrum::gaussian(f.excitation_nm, f.excitation_sigma_nm, f.absorptance),
            Spectrum::gaussian(f.emission_nm, f.emission_sigma_nm, 1.0), f.quantum_yield};
}

inline WavelengthGrid emission_10_nm() {
    return {380.0, 10.0, 41};
}
inline WavelengthGrid excitation_10_nm() {
    return {300.0, 10.0, 49};
}

/// The true matrix over a reflectance that leaves the absorbed light alone.
inline ReradiationMatrix true_matrix(const std::vector<TestFluorophore>& list,
                                     const WavelengthGrid& emission = emission_10_nm(),
                                     const WavelengthGrid& excitation = excitation_10_nm(),
                                     double reflectance = 0.1) {
    std::vector<Fluorophore> fluorophores;
    for (const TestFluorophore& f : list)
        fluorophores.push_back(as_fluorophore(f));
    return matrix_from_fluorophores(fluorophores, Spectrum::constant(reflectance), emission,
                                    excitation);
}

/// An orange and a green one, well apart.
inline std::vector<TestFluorophore> two_fluorophores() {
    return {{520.0, 35.0, 0.8, 600.0, 22.0, 0.9}, {380.0, 30.0, 0.6, 470.0, 25.0, 0.8}};
}

/// Returns the matrix of the fluorophores over a reflectance that leaves all light that they do not
/// absorb: a bright white.
inline ReradiationMatrix white_matrix(const std::vector<TestFluorophore>& list,
                                      const WavelengthGrid& emission,
                                      const WavelengthGrid& excitation) {
    std::vector<Fluorophore> fluorophores;
    for (const TestFluorophore& f : list)
        fluorophores.push_back(as_fluorophore(f));
    std::vector<double> nm, left;
    for (double l = 250.0; l <= 850.0; l += 1.0) {
        nm.push_back(l);
        left.push_back(1.0);
        for (const Fluorophore& f : fluorophores)
            left.back() -= f.excitation(l);
    }
    return matrix_from_fluorophores(fluorophores, Spectrum::table(nm, left), emission, excitation);
}

/// Uniform between limits, the same everywhere.
inline double uniform(std::mt19937& random, double from, double to) {
    return from + (to - from) * static_cast<double>(random()) * 0x1.0p-32;
}

/// Ordinary dyes of any colour that absorb at most 0.9 together.
inline std::vector<TestFluorophore> random_fluorophores(std::mt19937& random, int count) {
    std::vector<TestFluorophore> list;
    for (int k = 0; k < count; ++k) {
        TestFluorophore dye{};
        dye.excitation_nm = uniform(random, 330.0, 580.0);
        dye.excitation_sigma_nm = uniform(random, 18.0, 45.0);
        dye.absorptance = uniform(random, 0.1, 0.9) / count;
        dye.emission_nm = dye.excitation_nm + uniform(random, 30.0, 110.0);
        dye.emission_sigma_nm = uniform(random, 15.0, 40.0);
        dye.quantum_yield = uniform(random, 0.3, 0.95);
        list.push_back(dye);
    }
    return list;
}

/// Data as an instrument with the same noise everywhere sees them; sigma given when `tell`.
inline BispectralData noisy_data(const ReradiationMatrix& truth, double noise, bool tell,
                                 unsigned seed) {
    BispectralData data;
    data.file = "synthetic.csv";
    data.emission = truth.emission;
    data.excitation = truth.excitation;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    BispectralBlock block;
    block.value = truth.values;
    for (double& value : block.value.reshaped())
        value += noise * normal(random);
    block.sigma = Eigen::MatrixXd::Constant(block.value.rows(), block.value.cols(),
                                            tell && noise > 0.0 ? noise : not_measured);
    data.blocks.push_back(block);
    return data;
}

/// 1 where emission > excitation.
inline Eigen::MatrixXd stokes_entries(const ReradiationMatrix& matrix) {
    Eigen::MatrixXd mask(matrix.values.rows(), matrix.values.cols());
    for (int i = 0; i < matrix.excitation.count; ++i)
        for (int o = 0; o < matrix.emission.count; ++o)
            mask(o, i) =
                matrix.emission.centre_nm(o) > matrix.excitation.centre_nm(i) + 1e-6 ? 1.0 : 0.0;
    return mask;
}

/// Root mean square difference over entries with emission > excitation.
inline double stokes_rmse(const ReradiationMatrix& a, const ReradiationMatrix& b) {
    const Eigen::MatrixXd mask = stokes_entries(a);
    return std::sqrt((a.values - b.values).cwiseProduct(mask).squaredNorm() / mask.sum());
}

inline double stokes_peak(const ReradiationMatrix& matrix) {
    return matrix.values.cwiseProduct(stokes_entries(matrix)).maxCoeff();
}

/// Returns true when one of the lines holds these words.
inline bool says(const std::vector<std::string>& lines, const std::string& words) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.find(words) != std::string::npos;
    });
}

/// Share of entries with emission > excitation whose 95 % band holds the truth.
inline double coverage(const FitResult& fit, const ReradiationMatrix& truth) {
    const Eigen::MatrixXd mask = stokes_entries(truth);
    const Eigen::ArrayXXd inside =
        ((fit.matrix.values - truth.values).array().abs() <= 1.96 * fit.sigma.array() + 1e-12)
            .cast<double>();
    return (inside * mask.array()).sum() / mask.sum();
}

} // namespace reradiant
