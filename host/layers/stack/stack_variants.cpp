#include "host/layers/stack/stack_variants.h"

#include <utility>

namespace reradiant {

StackElements without_scattered(std::span<const StackElement> stack) {
    StackElements absorbing(stack.begin(), stack.end());
    for (StackElement& element : absorbing)
        if (auto* slab = std::get_if<SlabValues>(&element)) {
            slab->tau += slab->tau_scattering;
            slab->tau_scattering = 0.0;
        }
    return absorbing;
}

StackElements upside_down(std::span<const StackElement> sheet) {
    StackElements turned(sheet.rbegin(), sheet.rend());
    for (StackElement& element : turned)
        if (auto* surface = std::get_if<SurfaceValues>(&element))
            std::swap(surface->ior_above, surface->ior_below);
    return turned;
}

bool is_rough_interface(const StackElement& element) {
    return std::holds_alternative<SurfaceValues>(element) && scatters(element);
}

} // namespace reradiant
