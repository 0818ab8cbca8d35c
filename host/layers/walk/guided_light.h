#pragma once

#include "host/layers/walk/walk_elements.h"
#include "host/layers/walk/walk_random.h"
#include "kernels/core/portable.h"

#include <optional>
#include <vector>

namespace reradiant {

/// `GuidedLight` is light of one band that goes to and fro between two smooth faces which reflect
/// all of it, through one slab or through several with smooth interfaces between them. Only an
/// event in a slab ends that, which may be millions of passages away or never come; where it comes
/// is drawn at once, from the exact distribution.
class GuidedLight {
public:
    /// Where a slab takes up or scatters the light, and in which direction it was going.
    struct Event {
        std::size_t element;
        kernels::Vec3 d;
        double z; ///< share of the slab that lies above
    };

    /// Returns light that travels along d in the slab `element`, or nothing if some face lets it
    /// go.
    static std::optional<GuidedLight> find(const WalkElements& elements, std::size_t element,
                                           const kernels::Vec3& d);

    /// Returns the next event of light that has just come to the end of its slab, by the extinction
    /// of the slabs; nothing if they are clear, and it goes on for ever.
    std::optional<Event> next_event(WalkRandom& random) const;

private:
    struct Passage {
        std::size_t element;
        double ior, cosine;
        double depth;                   ///< of extinction along it
        double reflected_beneath = 1.0; ///< at the interface beneath the slab
    };

    GuidedLight(const WalkElements& elements, std::size_t element, const kernels::Vec3& d);
    Passage passage(std::size_t element) const;
    bool close_downwards();
    bool close_upwards();
    bool is_clear() const;
    /// The light is in one of as many states as twice the passages: first all down, then all up.
    std::size_t state_after_face(WalkRandom& random) const;
    Eigen::MatrixXd transitions() const;
    Eigen::VectorXd chances_of_events(std::size_t state) const;

    const WalkElements& elements_;
    kernels::Vec3 d_;
    std::size_t here_ = 0;          ///< the passage that the light has just made
    std::vector<Passage> passages_; ///< of the slabs, from the air down
};

} // namespace reradiant
