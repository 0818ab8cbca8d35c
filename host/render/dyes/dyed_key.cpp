#include "host/render/dyes/dyed_key.h"

#include "host/render/checkpoint/render_identity.h"
#include "host/scene/model/sha256.h"

#include <type_traits>
#include <variant>

namespace reradiant {

namespace {

/// Takes numbers into a digest one after the other. What holds several says how many, so that no
/// two stacks give the same numbers.
class NumberDigest {
public:
    explicit NumberDigest(const std::string& build) { sha_.update(build); }

    template <typename T>
    void add(T value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        const auto number = static_cast<double>(value);
        sha_.update({reinterpret_cast<const char*>(&number), sizeof number});
    }
    void add_matrix(const Eigen::MatrixXd& matrix) {
        add(matrix.rows());
        add(matrix.cols());
        sha_.update({reinterpret_cast<const char*>(matrix.data()),
                     static_cast<std::size_t>(matrix.size()) * sizeof(double)});
    }
    void add_element(const SurfaceValues& surface) {
        add(surface.ior_above);
        add(surface.ior_below);
        add(surface.kappa);
        add(surface.is_conductor);
        add(surface.distribution);
        add(surface.alpha);
        add(surface.scattering);
        add(surface.film.thickness_nm);
        add(surface.film.ior);
        add(surface.wavelength_nm);
    }
    void add_element(const SlabValues& slab) {
        add(slab.ior);
        add(slab.tau);
        add(slab.tau_scattering);
        add(slab.anisotropy);
        add(slab.may_scatter);
        add(slab.tau_dyes);
    }
    void add_element(const FlakesValues& flakes) {
        add(flakes.coverage);
        add_element(flakes.reflector);
    }
    void add_element(const DiffuseValues& substrate) {
        add(substrate.ior_above);
        add(substrate.sigma);
    }
    std::string hex() const { return sha_.hex(); }

private:
    Sha256 sha_;
};

} // namespace

std::string dyed_key(const std::vector<DyedStack>& by_phase) {
    NumberDigest digest(build_digest());
    digest.add(by_phase.size());
    for (const DyedStack& stack : by_phase) {
        digest.add(stack.by_band.size());
        for (const StackElements& band : stack.by_band) {
            digest.add(band.size());
            for (const StackElement& element : band) {
                digest.add(element.index());
                std::visit([&](const auto& values) { digest.add_element(values); }, element);
            }
        }
        digest.add(stack.slabs.size());
        for (const Eigen::MatrixXd& slab : stack.slabs)
            digest.add_matrix(slab);
        digest.add_matrix(stack.substrate);
    }
    return digest.hex();
}

} // namespace reradiant
