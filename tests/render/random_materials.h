#pragma once

#include "reradiant/scene.h"
#include "tests/render/test_scenes.h"

#include <random>

namespace reradiant::test {

/// Materials with every number in its range or at an edge of it; the same seed gives the same.
class RandomMaterials {
public:
    /// Rough interfaces take some seconds of tables for every new IOR and roughness: there are
    /// `interfaces` of them, the first of which is GGX of 0.2 at 1.5.
    RandomMaterials(unsigned seed, int interfaces) : engine_(seed), interfaces_(interfaces) {}

    Material material(int most_layers = 3) {
        Material result;
        result.name = "random";
        for (int i = integer(most_layers + 1); i > 0; --i)
            result.stack.layers.push_back(random_layer());
        substrate(result.substrate);
        return result;
    }
    /// One of the given numbers, or between the first and the last.
    double edge_or_between(const std::vector<double>& edges) {
        return chance(0.5)
                   ? edges[static_cast<std::size_t>(integer(static_cast<int>(edges.size())))]
                   : uniform(edges.front(), edges.back());
    }
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(engine_);
    }
    int integer(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
    bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

private:
    Layer random_layer() {
        const bool is_rough = chance(0.3);
        Layer result = layer(pooled(64, {1.0, 1.000001, 1.0001, 1.5, 2.4, 4.0}), 0.0,
                             chance(0.5) ? 0.0 : edge_or_between({0.0, 1e-8, 1e-3, 1.0, 1e4}));
        if (is_rough)
            make_rough(result, integer(interfaces_));
        return result;
    }
    /// One of `count` numbers: tables that facets need are kept, and take some hundredths of a
    /// second for every new roughness and ratio of IORs.
    double pooled(int count, const std::vector<double>& edges) {
        return RandomMaterials(static_cast<unsigned>(integer(count)), 1).edge_or_between(edges);
    }
    static void make_rough(Layer& layer, int interface) {
        std::mt19937_64 engine(static_cast<unsigned>(interface));
        const auto between = [&](double from, double to) {
            return std::uniform_real_distribution<double>(from, to)(engine);
        };
        layer.ior = Spectrum::constant(interface == 0 ? 1.5 : between(1.1, 2.5));
        layer.alpha = interface == 0 ? 0.2 : between(0.02, 0.9);
        layer.distribution = interface % 2 == 0 ? Distribution::Ggx : Distribution::Beckmann;
    }
    void substrate(Substrate& result) {
        result.reflectance = Spectrum::constant(edge_or_between({0.0, 1e-6, 0.5, 0.999999, 1.0}));
        const int type = integer(4);
        if (type == 0) {
            result.type = SubstrateType::OrenNayar;
            result.sigma = edge_or_between({0.0, 1e-4, 0.3, 1.5});
        } else if (type == 1) {
            result.type = SubstrateType::Conductor;
            result.conductor.ior = Spectrum::constant(edge_or_between({0.05, 0.3, 1.5, 4.0}));
            result.conductor.kappa = Spectrum::constant(edge_or_between({1e-6, 0.5, 3.0, 10.0}));
            result.conductor.alpha = chance(0.5) ? 0.0 : pooled(256, {0.001, 0.02, 0.3, 1.0});
        } else if (type == 2) {
            ReradiationMatrix matrix = shifted_matrix();
            matrix.values *= uniform(0.0, 1.0);
            result.matrix = std::make_shared<const ReradiationMatrix>(matrix);
            result.reflectance = result.matrix->reflectance();
        }
    }

    std::mt19937_64 engine_;
    int interfaces_;
};

} // namespace reradiant::test
