#include "reradiant/synth.h"

#include <cmath>
#include <random>
#include <stdexcept>

namespace reradiant {

namespace {

/// Random numbers of one data set, in the order of its entries.
class Noise {
public:
    Noise(const SynthNoise& noise, double peak, unsigned seed)
        : noise_(noise), peak_(peak), engine_(seed) {}

    double sigma(double signal) const {
        const double read = noise_.read_of_peak * peak_, relative = noise_.relative * signal;
        const double shot =
            noise_.shot_counts_at_peak > 0.0 ? signal * peak_ / noise_.shot_counts_at_peak : 0.0;
        return std::sqrt(read * read + relative * relative + shot);
    }

    double measured(double signal) {
        double value = counted(signal);
        value += noise_.relative * signal * normal_(engine_);
        return value + noise_.read_of_peak * peak_ * normal_(engine_);
    }

private:
    double counted(double signal) {
        if (!(noise_.shot_counts_at_peak > 0.0) || !(signal > 0.0))
            return signal;
        const double counts_per_unit = noise_.shot_counts_at_peak / peak_;
        std::poisson_distribution<long long> photons(signal * counts_per_unit);
        return static_cast<double>(photons(engine_)) / counts_per_unit;
    }

    SynthNoise noise_;
    double peak_;
    std::mt19937_64 engine_;
    std::normal_distribution<double> normal_;
};

bool is_diagonal(const SynthRecipe& recipe, Eigen::Index o, Eigen::Index i) {
    const double away = recipe.emission.centre_nm(static_cast<int>(o)) -
                        recipe.excitation.centre_nm(static_cast<int>(i));
    return std::abs(away) < 1e-6 * recipe.excitation.step_nm;
}

/// Calls visit(block, o, i) for every entry off the diagonal.
template <typename Visit>
void for_off_diagonal(const SynthRecipe& recipe, std::size_t blocks, const Visit& visit) {
    for (std::size_t block = 0; block < blocks; ++block)
        for (Eigen::Index i = 0; i < recipe.excitation.count; ++i)
            for (Eigen::Index o = 0; o < recipe.emission.count; ++o)
                if (!is_diagonal(recipe, o, i))
                    visit(block, o, i);
}

double fluorescent_peak(const SynthRecipe& recipe, const std::vector<Eigen::MatrixXd>& seen) {
    double peak = 0.0;
    for_off_diagonal(recipe, seen.size(), [&](std::size_t block, Eigen::Index o, Eigen::Index i) {
        peak = std::max(peak, seen[block](o, i));
    });
    return peak;
}

/// What falls on the sample of a lamp that data are not corrected for.
Eigen::VectorXd lamp_of(const SynthRecipe& recipe) {
    Eigen::VectorXd lamp = Eigen::VectorXd::Ones(recipe.excitation.count);
    if (!recipe.instrument.lamp)
        return lamp;
    for (int i = 0; i < recipe.excitation.count; ++i)
        lamp(i) = (*recipe.instrument.lamp)(recipe.excitation.centre_nm(i));
    if (!(lamp.mean() > 0.0))
        throw std::invalid_argument("the lamp gives no light in the excitation bands");
    return lamp / lamp.mean();
}

/// Brings readings to the instrument's unit, in which it is full at some value.
void read_in_unit(const SynthInstrument& instrument, BispectralBlock& block) {
    block.value *= instrument.scale;
    block.sigma *= instrument.scale;
    if (instrument.ceiling)
        block.value = block.value.cwiseMin(*instrument.ceiling);
}

BispectralBlock noisy_block(const Eigen::MatrixXd& seen, Noise& noise) {
    BispectralBlock block;
    block.value = block.sigma = seen;
    for (Eigen::Index i = 0; i < seen.cols(); ++i)
        for (Eigen::Index o = 0; o < seen.rows(); ++o) {
            block.value(o, i) = noise.measured(seen(o, i));
            block.sigma(o, i) = noise.sigma(seen(o, i));
        }
    return block;
}

} // namespace

SynthResult synthesise(const SynthRecipe& recipe, unsigned seed) {
    std::vector<Eigen::MatrixXd> seen = synth_noise_free(recipe);
    for (Eigen::MatrixXd& values : seen)
        values *= lamp_of(recipe).asDiagonal();
    SynthResult result;
    result.peak = fluorescent_peak(recipe, seen);
    if (!(result.peak > 0.0))
        throw std::invalid_argument("nothing fluoresces on these emission and excitation bands");
    for (Eigen::MatrixXd& values : seen)
        add_spill(recipe, values);
    result.data.emission = recipe.emission;
    result.data.excitation = recipe.excitation;
    Noise noise(recipe.noise, result.peak, seed);
    for (std::size_t block = 0; block < seen.size(); ++block) {
        result.data.blocks.push_back(noisy_block(seen[block], noise));
        if (!recipe.geometries.empty())
            result.data.blocks.back().geometry = recipe.geometries[block];
    }
    double squares = 0.0, count = 0.0;
    for_off_diagonal(recipe, seen.size(), [&](std::size_t block, Eigen::Index o, Eigen::Index i) {
        squares += std::pow(result.data.blocks[block].value(o, i) - seen[block](o, i), 2);
        count += 1.0;
    });
    result.noise_rms = count > 0.0 ? std::sqrt(squares / count) : 0.0;
    for (BispectralBlock& block : result.data.blocks)
        read_in_unit(recipe.instrument, block);
    return result;
}

} // namespace reradiant
