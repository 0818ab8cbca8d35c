#include "host/layers/smooth/smooth_transport.h"

#include "host/layers/models/adding.h"
#include "host/layers/smooth/smooth_stack.h"
#include "host/layers/stack/quadrature.h"

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

constexpr int integration_nodes = 64;

class SmoothTransport final : public AddingModel {
public:
    explicit SmoothTransport(std::span<const StackElement> stack)
        : AddingModel(stack), stack_(smooth_pile(1.0, stack)) {
        internal_reflectance_ =
            1.0 - integrate_over_lowest([](double loss_up, double) { return loss_up; });
        internal_reflectance_ = std::clamp(internal_reflectance_, 0.0, 1.0);
    }

    double transmission(double c) const override { return response(c).transmission; }
    double internal_reflectance(double sigma) const override {
        return oren_nayar_feedback(sigma, internal_reflectance_, [&](const SubstrateWeight& w) {
            return integrate_over_lowest(
                [&](double loss_up, double c) { return square(w(c)) * (1.0 - loss_up); });
        });
    }
    double specular_albedo(double c) const override { return response(c).reflection_down; }
    double specular_delta(double c) const override { return response(c).reflection_down; }
    bool has_top_lobe() const override { return false; }
    const std::vector<LobeShape>& deeper_lobes() const override { return no_lobes_; }
    std::vector<double> lobe_shares(double) const override { return {0.0}; }
    double lobe_amplitude(int, double) const override { return 0.0; }
    double residual(double) const override { return 0.0; }
    double residual_average() const override { return 0.0; }
    double lost(double) const override { return 0.0; }

private:
    SmoothResponse response(double c) const {
        return smooth_response(stack_, 1.0, std::clamp(c, 0.0, 1.0));
    }

    static double square(double x) { return x * x; }

    /// 2 integral of a function of (1 - R_up, c) c dc over the lowest medium, split at every
    /// critical cosine and at the scale where a denser medium above changes the path.
    template <typename Function>
    double integrate_over_lowest(const Function& function) const {
        const double n = stack_.ior.back();
        std::vector<double> inner;
        for (const double above : stack_.ior)
            inner.push_back(std::sqrt(std::fabs((n - above) * (n + above))) / n);
        return integrate_pieces(breaks_between_0_and_1(inner), integration_nodes, [&](double c) {
            return 2.0 * c * function(smooth_response(stack_, n, c).loss_up, c);
        });
    }

    SmoothStack stack_;
    double internal_reflectance_ = 0.0;
    std::vector<LobeShape> no_lobes_;
};

} // namespace

std::shared_ptr<const StackBsdf> smooth_transport(std::span<const StackElement> stack) {
    return std::make_shared<SmoothTransport>(stack);
}

} // namespace reradiant
