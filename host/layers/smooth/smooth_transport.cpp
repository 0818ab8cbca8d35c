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
        const double lost = integrate_pieces(breaks_in_lowest(), integration_nodes,
                                             [this](double c) { return 2.0 * c * loss_up(c); });
        internal_reflectance_ = std::clamp(1.0 - lost, 0.0, 1.0);
    }

    double transmission(double c) const override { return response(c).transmission; }
    double specular_albedo(double c) const override { return response(c).reflection_down; }
    double specular_delta(double c) const override { return response(c).reflection_down; }
    bool has_top_lobe() const override { return false; }
    const std::vector<LobeShape>& deeper_lobes() const override { return no_lobes_; }
    std::vector<double> lobe_shares(double) const override { return {0.0}; }
    double lobe_amplitude(int, double) const override { return 0.0; }
    double residual(double) const override { return 0.0; }
    double residual_average() const override { return 0.0; }
    double lost(double) const override { return 0.0; }

protected:
    double diffuse_reflectance() const override { return internal_reflectance_; }
    Eigen::MatrixXd returned_to_substrate(const CosineNodes& nodes) const override {
        Eigen::MatrixXd returned = Eigen::MatrixXd::Zero(nodes.size(), nodes.size());
        for (Eigen::Index node = 0; node + 1 < nodes.size(); ++node)
            add_returned(nodes, node, returned);
        return returned;
    }

private:
    SmoothResponse response(double c) const {
        return smooth_response(stack_, 1.0, std::clamp(c, 0.0, 1.0));
    }

    /// Adds what comes back between two nodes.
    void add_returned(const CosineNodes& nodes, Eigen::Index node,
                      Eigen::MatrixXd& returned) const {
        const double low = nodes.cosine(node), high = nodes.cosine(node + 1);
        std::vector<double> breaks{low, high};
        for (const double c : breaks_in_lowest())
            if (c > low && c < high)
                breaks.push_back(c);
        std::sort(breaks.begin(), breaks.end());
        Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
        for (int i = 0; i < 2; ++i)
            for (int o = 0; o < 2; ++o)
                sum(i, o) = integrate_pieces(breaks, 16, [&](double c) {
                    const double t = (c - low) / (high - low);
                    return 2.0 * c * (1.0 - loss_up(c)) * (i == 0 ? 1.0 - t : t) *
                           (o == 0 ? 1.0 - t : t);
                });
        returned.block<2, 2>(node, node) += sum;
    }

    double loss_up(double c) const { return smooth_response(stack_, stack_.ior.back(), c).loss_up; }

    /// Pieces of the cosine in the lowest medium: every critical cosine, and the scale where a
    /// denser medium above changes the path.
    std::vector<double> breaks_in_lowest() const {
        const double n = stack_.ior.back();
        std::vector<double> inner;
        for (const double above : stack_.ior)
            inner.push_back(std::sqrt(std::fabs((n - above) * (n + above))) / n);
        return breaks_between_0_and_1(inner);
    }

    SmoothStack stack_;
    double internal_reflectance_ = 0.0;
    std::vector<LobeShape> no_lobes_;
};

} // namespace

std::shared_ptr<const AddingModel> smooth_transport(std::span<const StackElement> stack) {
    return std::make_shared<SmoothTransport>(stack);
}

} // namespace reradiant
