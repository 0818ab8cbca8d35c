#pragma once

#include "reradiant/stack_elements.h"
#include "reradiant/stack_model.h"

#include <memory>
#include <optional>
#include <string>

namespace reradiant {

/// Returns why adding cannot do a stack, or nothing if it can: it knows no flakes, and an operator
/// of a rough interface for each wavelength of a film costs too much (about a second each).
std::optional<std::string> adding_refusal(const LayerStack& stack);

/// Returns model B (`adding`) of the stack above a diffuse substrate, whether or not the list holds
/// that. It is cheap for smooth clear stacks (closed form); for rough ones the interfaces'
/// scattering operators are computed once per (IOR ratio, distribution, alpha, scattering) and kept
/// in memory and in the disk cache; slabs that scatter take some 10 ms each. Thread-safe. Throws an
/// input Error for numbers out of range and for what adding cannot do.
std::shared_ptr<const StackModel> adding_transport(const StackElements& stack);

} // namespace reradiant
