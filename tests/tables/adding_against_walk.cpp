// Adding against the random walk, as Markdown tables: BRRDFs of stacks over a bispectral
// Lambertian substrate, the white furnace with what `single` loses, and reciprocity.
#include "host/layers/stack/directions.h"
#include "tests/layers/walk_stacks.h"
#include "tests/support/statistics.h"

#include <fmt/core.h>

#include <algorithm>

using namespace reradiant;

namespace {

int failures = 0;

const char* judged(bool good) {
    failures += good ? 0 : 1;
    return good ? "" : " **out of bounds**";
}

std::string name_of(const LayerStack& stack) {
    std::string name;
    for (const Layer& layer : stack.layers) {
        name += fmt::format("{}n {} a {} t {} {}", name.empty() ? "" : " / ", layer.ior(500.0),
                            layer.alpha, layer.absorption(500.0),
                            layer.scattering == Scattering::Single ? "single" : "multiple");
    }
    return name;
}

/// One slab over IOR, roughness and scattering, its depth taken in turn; then two and three.
std::vector<LayerStack> stacks_to_compare() {
    std::vector<LayerStack> stacks;
    const double depths[] = {0.0, 0.1, 1.0, 5.0};
    for (const Scattering scattering : {Scattering::Multiple, Scattering::Single}) {
        for (const double ior : {1.2, 1.5, 2.4}) {
            for (const double alpha : {0.02, 0.2, 0.6}) {
                const double tau = depths[stacks.size() % 4];
                stacks.push_back({{plain_layer(ior, alpha, tau, scattering)}});
            }
        }
        const auto layer = [&](double ior, double alpha, double tau) {
            return plain_layer(ior, alpha, tau, scattering);
        };
        stacks.push_back({{layer(1.2, 0.2, 0.1), layer(1.5, 0.2, 0.5)}});
        stacks.push_back({{layer(1.5, 0.0, 0.2), layer(1.2, 0.6, 0.0)}});
        stacks.push_back({{layer(1.5, 0.2, 0.0), layer(1.2, 0.0, 0.3), layer(1.5, 0.2, 0.1)}});
        stacks.push_back({{layer(1.2, 0.6, 0.1), layer(1.5, 0.2, 0.1), layer(1.8, 0.0, 0.1)}});
    }
    return stacks;
}

/// Walks until the rarest entry of the BRRDF is known to 0.3 %, or a bound of effort.
WalkEstimate precise_estimate(const LayerWalk& walk, const kernels::Vec3& wi,
                              const kernels::Vec3& wo, std::uint64_t seed) {
    for (std::uint64_t samples = 1U << 15U;; samples *= 4) {
        WalkEstimate found = estimate_walk(walk, wi, {&wo, 1}, samples, seed);
        const auto& mean = found.mean.directional[0].diffuse;
        const auto& error = found.standard_error.directional[0].diffuse;
        if ((error.array() <= 0.003 * mean.array()).all() || samples >= (1U << 21U))
            return found;
    }
}

void compare_models() {
    const std::vector<LayerStack> stacks = stacks_to_compare();
    // through a depth of 5 hardly a walk reaches the substrate at a slant
    const std::vector<std::pair<double, double>> wide{{0, 30}, {70, 55}}, steep{{0, 30}, {10, 20}};
    const double comparisons = 3.0 * static_cast<double>(stacks.size() * wide.size());
    const double bound = test::sidak_bound(comparisons);
    fmt::print("## BRRDF over a bispectral Lambertian substrate\n\n{} pairs of stack and angles, "
               "bound of {:.2f} standard errors\n\n"
               "| stack | in, out deg | adding 400 to 600 | walk | s.e. % | largest z of 3 |\n"
               "| --- | --- | --- | --- | --- | --- |\n",
               stacks.size() * wide.size(), bound);
    double worst = 0.0, worst_error = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < stacks.size(); ++k) {
        const LayerWalk walk(stacks[k], {.matrix = bispectral_matrix()}, two_bands_nm);
        const bool deep = stacks[k].layers[0].absorption(500.0) > 1.0;
        for (const auto& [theta_i, theta_o] : deep ? steep : wide) {
            const kernels::Vec3 wi = test::direction_deg(theta_i, 0),
                                wo = test::direction_deg(theta_o, 60);
            const AddingValues adding = adding_values(stacks[k], wi, wo);
            const WalkEstimate found = precise_estimate(walk, wi, wo, k);
            const Eigen::MatrixXd& mean = found.mean.directional[0].diffuse;
            const Eigen::MatrixXd& error = found.standard_error.directional[0].diffuse;
            double z = 0.0, relative = 0.0;
            for (const auto& [o, i] : {std::pair{0, 0}, {1, 0}, {1, 1}}) {
                const double one = (mean(o, i) - adding.diffuse(o, i)) / error(o, i);
                z = std::fabs(one) > std::fabs(z) ? one : z;
                relative = std::max(relative, error(o, i) / mean(o, i));
                squares += one * one;
            }
            worst = std::max(worst, std::fabs(z));
            worst_error = std::max(worst_error, relative);
            fmt::print("| {} | {}, {} | {:.6f} | {:.6f} | {:.2f} | {:.2f}{} |\n",
                       name_of(stacks[k]), theta_i, theta_o, adding.diffuse(1, 0), mean(1, 0),
                       100 * relative, z, judged(std::fabs(z) <= bound && relative <= 0.003));
            std::fflush(stdout);
        }
    }
    fmt::print("\nlargest |z| {:.2f}, root mean square of z {:.2f}, largest standard error "
               "{:.2f} %\n\n",
               worst, std::sqrt(squares / comparisons), 100 * worst_error);
}

/// 2 integral c T dc / n^2: share of a diffuse exitance that leaves through the stack.
double adding_escape(const StackElements& stack) {
    const auto t = adding_transport(stack);
    const double n = t->lowest_ior();
    return integrate_pieces(breaks_in_air(stack), 64,
                            [&](double c) { return 2.0 * c * t->transmission(c); }) /
           (n * n);
}

/// Albedo over a white Lambertian substrate by adding.
double adding_albedo(const StackElements& stack, double cosine) {
    const auto t = adding_transport(stack);
    return t->specular_albedo(cosine) +
           t->transmission(cosine) * adding_escape(stack) / (1.0 - t->internal_reflectance());
}

LayerStack white_stack(int slabs, double ior, double alpha, Scattering scattering) {
    LayerStack stack;
    for (int k = 0; k < slabs; ++k)
        stack.layers.push_back(plain_layer(k % 2 == 0 ? ior : 1.25 * ior, alpha, 0.0, scattering));
    return stack;
}

void white_furnace() {
    fmt::print("## White furnace\n\nAlbedo over a white Lambertian substrate; a second slab has "
               "1.25 n, a third n again\n\n"
               "| slabs | n | alpha | theta | multiple, adding | multiple, walk | lost by single, "
               "adding | walk | s.e. |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const SubstrateValues white{.matrix = Eigen::MatrixXd::Identity(1, 1)};
    const double bound = test::sidak_bound(108);
    for (int slabs = 1; slabs <= 3; ++slabs) {
        for (const double ior : {1.2, 1.5, 2.4}) {
            for (const double alpha : {0.02, 0.1, 0.3, 0.6}) {
                const LayerStack multiple = white_stack(slabs, ior, alpha, Scattering::Multiple);
                const LayerStack single = white_stack(slabs, ior, alpha, Scattering::Single);
                const LayerWalk follows(multiple, white, {550.0}), loses(single, white, {550.0});
                for (const double theta : {0.0, 40.0, 80.0}) {
                    const kernels::Vec3 wi = test::direction_deg(theta, 0);
                    const double adding = adding_albedo(stack_at(multiple, 550.0), wi.z);
                    const double lost = 1.0 - adding_albedo(stack_at(single, 550.0), wi.z);
                    const auto albedo = [](const WalkTally& tally) {
                        return tally.hemispherical.diffuse(0) + tally.hemispherical.specular(0);
                    };
                    const double walk = albedo(estimate_walk(follows, wi, {}, 4096, 1).mean);
                    const WalkEstimate found = estimate_walk(loses, wi, {}, 1U << 15U, 2);
                    const double error = albedo(found.standard_error);
                    const double walk_lost = 1.0 - albedo(found.mean);
                    // to the standard errors, 0.5 % of the light for the cells of direction
                    const bool good = std::fabs(adding - 1.0) <= 5e-3 &&
                                      std::fabs(walk - 1.0) <= 5e-3 &&
                                      std::fabs(lost - walk_lost) <= bound * error + 5e-3;
                    fmt::print("| {} | {} | {} | {} | {:.6f} | {:.6f} | {:.4f} | {:.4f} | "
                               "{:.4f}{} |\n",
                               slabs, ior, alpha, theta, adding, walk, lost, walk_lost, error,
                               judged(good));
                    std::fflush(stdout);
                }
            }
        }
    }
}

/// Adding: 2 integral c T dc = n^2 (1 - r), which makes its two T's one. Walk: light backwards.
void reciprocity() {
    fmt::print("\n## Reciprocity\n\n| stack | adding: 2 integral c T dc / (n^2 (1 - r)) - 1 | "
               "walk there | and back | z |\n| --- | --- | --- | --- | --- |\n");
    const kernels::Vec3 a = test::direction_deg(20, 0), b = test::direction_deg(65, 50);
    std::vector<LayerStack> stacks = stacks_to_compare();
    std::erase_if(stacks, [](const LayerStack& s) { return s.layers.size() == 1; });
    stacks.push_back({{cloudy_layer(1.5, 0.2, 0.0, 1.0, 0.6), plain_layer(1.2, 0.2, 0.0)}});
    const double bound = test::sidak_bound(static_cast<double>(stacks.size()));
    for (LayerStack& stack : stacks) {
        const LayerWalk walk(stack, {.matrix = bispectral_matrix()}, two_bands_nm);
        const WalkEstimate there = estimate_walk(walk, a, {&b, 1}, 1U << 16U, 1);
        const WalkEstimate back = estimate_walk(walk.reversed(), b, {&a, 1}, 1U << 16U, 2);
        const double x = there.mean.directional[0].diffuse(1, 0);
        const double y = back.mean.directional[0].diffuse(0, 1);
        const double z = (x - y) / std::hypot(there.standard_error.directional[0].diffuse(1, 0),
                                              back.standard_error.directional[0].diffuse(0, 1));
        const std::string name = name_of(stack);
        for (Layer& layer : stack.layers) {
            layer.absorption = Spectrum::constant(0.0);
            layer.scattering = Scattering::Multiple;
        }
        // of the same stack without losses, where what does not come back gets out
        const StackElements lossless = stack_at(stack, 550.0);
        const double excess =
            adding_escape(lossless) / (1.0 - adding_transport(lossless)->internal_reflectance()) -
            1.0;
        fmt::print("| {} | {:.1e} | {:.6f} | {:.6f} | {:.2f}{} |\n", name, excess, x, y, z,
                   judged(std::fabs(z) <= bound && std::fabs(excess) <= 1e-8)); // 64 nodes a piece
        std::fflush(stdout);
    }
}

} // namespace

int main() {
    compare_models();
    white_furnace();
    reciprocity();
    fmt::print("\n{} figures out of bounds\n", failures);
    return failures > 0 ? 3 : 0;
}
