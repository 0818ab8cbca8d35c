#pragma once

#include "reradiant/device.h"
#include "reradiant/merge.h"
#include "reradiant/render.h"

#include <string>

namespace reradiant {

/// Returns what decides which samples a render takes: the scene (its digest) and the options that
/// matter. Parts of one render on different machines share it.
SampleIdentity sampling_identity(const Scene& scene, const RenderOptions& options);

/// Returns the facts of sampling_identity, the first sample, the build (digest of the running
/// program and of the kernels) and the device: two renders that share all of these give the same
/// sums, bit for bit. The number of samples is not part of it, since a resumed render may go
/// further than the interrupted one was asked to; threads and batches do not matter.
SampleIdentity render_identity(const Scene& scene, const Device& device,
                               const RenderOptions& options);

/// Digest of the running program and of the kernels' sources.
const std::string& build_digest();

/// One digest of all facts, 64 hex digits.
std::string identity_digest(const SampleIdentity& identity);

} // namespace reradiant
