#pragma once

#include "host/layers/sources/source_transport.h"
#include "reradiant/stack_elements.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace reradiant {

/// A stack at one wavelength in which dyes scatter what they send out in the band that they absorb:
/// re-emission within a band is isotropic scattering.
///
/// Where hardly any light is lost it diffuses through slabs of many free paths, and cells as thick
/// as some of these, each of uniform emission, let it through too easily: neighbours exchange 1/4
/// of their difference instead of 1/(3 depth). A slab that scatters is added up exactly.
struct ScatteringDyes {
    StackElements stack;
    std::vector<double> depths; ///< by slab: the optical depth that scatters
};

/// Returns such a stack for a band where some slab is thick and loses little, else nothing.
/// `slabs` is what dyes send out (host/layers/stack/slab_emission.h).
std::optional<ScatteringDyes> scattering_dyes(const StackElements& stack,
                                              const std::vector<Eigen::MatrixXd>& slabs,
                                              Eigen::Index band);

/// The transport of such a stack; null where none is needed.
struct ScatteringTransport {
    std::shared_ptr<const SourceTransport> transport;
    std::vector<double> depths; ///< as in ScatteringDyes
};

} // namespace reradiant
