#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

namespace reradiant {

static Quadrature make_gauss_legendre(int count) {
    Quadrature rule;
    for (int i = 0; i < count; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 100; ++step) {
            double p0 = 1.0, p1 = x;
            for (int k = 2; k <= count; ++k) {
                const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            slope = count * (x * p1 - p0) / (x * x - 1.0);
            const double change = p1 / slope;
            x -= change;
            if (std::fabs(change) < 1e-15)
                break;
        }
        rule.nodes.push_back(0.5 * (1.0 - x));
        rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

const Quadrature& gauss_legendre(int count) {
    static std::mutex mutex;
    static std::map<int, std::unique_ptr<Quadrature>> rules;
    const std::scoped_lock lock(mutex);
    std::unique_ptr<Quadrature>& rule = rules[count];
    if (!rule)
        rule = std::make_unique<Quadrature>(make_gauss_legendre(count));
    return *rule;
}

std::vector<double> breaks_between_0_and_1(std::vector<double> inner) {
    std::erase_if(inner, [](double x) { return !(x > 1e-14 && x < 1.0 - 1e-14); });
    inner.push_back(0.0);
    inner.push_back(1.0);
    std::sort(inner.begin(), inner.end());
    inner.erase(
        std::unique(inner.begin(), inner.end(), [](double a, double b) { return b - a < 1e-14; }),
        inner.end());
    return inner;
}

} // namespace reradiant
