#include "host/view/tables/dyed_tables.h"

#include "host/layers/models/layered_bsdf.h"
#include "host/layers/rough/specular_lobes.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "host/view/tables/model_tables.h"

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Chebyshev's nodes between almost grazing and the normal.
double node_cosine(int node, int nodes) {
    return 0.51 - 0.49 * std::cos(std::numbers::pi * (node + 0.5) / nodes);
}

/// The material's stack at a band with clear slabs.
std::shared_ptr<const StackBsdf> clear_model(const Material& material, double wavelength_nm) {
    StackElements stack = material_at(material, wavelength_nm);
    for (StackElement& element : stack)
        if (auto* slab = std::get_if<SlabValues>(&element))
            *slab = {.ior = slab->ior};
    return closed_model(Model::Adding)(stack);
}

/// What they let through, a band each.
class ClearWay {
public:
    ClearWay(const Material& material, const WavelengthGrid& bands) {
        for (const double nm : bands.centres_nm())
            models_.push_back(clear_model(material, nm));
    }
    Eigen::VectorXd at(double cosine) const {
        Eigen::VectorXd shares(static_cast<Eigen::Index>(models_.size()));
        for (std::size_t band = 0; band < models_.size(); ++band)
            shares(static_cast<Eigen::Index>(band)) = models_[band]->transmission(cosine);
        return shares;
    }
    /// By band and node of CosineTable.
    std::vector<double> tables() const {
        std::vector<double> numbers;
        for (const auto& model : models_)
            for (int node = 0; node < CosineTable::nodes; ++node)
                numbers.push_back(model->transmission(CosineTable::node_cosine(node)));
        return numbers;
    }

private:
    std::vector<std::shared_ptr<const StackBsdf>> models_;
};

} // namespace

nlohmann::ordered_json dyed_tables(const Material& material, const WavelengthGrid& bands,
                                   int nodes) {
    const LayeredBsdf surface(material.stack, measured_substrate(material.substrate, bands), bands,
                              closed_model(Model::Adding));
    const EmittingStack& dyes = *surface.emitting();
    const ClearWay clear(material, bands);
    std::vector<double> cosines, numbers;
    for (int node = 0; node < nodes; ++node)
        cosines.push_back(node_cosine(node, nodes));
    for (const double out : cosines)
        for (const double in : cosines) {
            const Eigen::VectorXd through_out = clear.at(out), through_in = clear.at(in);
            const Eigen::MatrixXd value =
                dyes.value({in, Side::Above}, {out, Side::Above}, EmittingStack::Part::All);
            for (Eigen::Index o = 0; o < value.rows(); ++o)
                for (Eigen::Index i = 0; i < (dyes.shifts_up() ? o + 1 : value.cols()); ++i)
                    numbers.push_back(value(o, i) / (through_out(o) * through_in(i)));
        }
    return {{"nodes", cosines},
            {"isLower", dyes.shifts_up()},
            {"through", encoded_floats(clear.tables())},
            {"numbers", encoded_floats(numbers)}};
}

} // namespace reradiant
