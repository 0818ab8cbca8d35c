#pragma once

#include "host/device/source.h"

#include <cstddef>
#include <filesystem>

namespace reradiant {

/// Bytes of the renderer's kernel programs that the preprocessor (the host compiler's) lets
/// through, without comments and blank lines. Run-time Error when it does not run.
std::size_t preprocessed_bytes(const std::filesystem::path& root, const KernelDefines& defines);

/// Machine instructions of all kernels that PoCL keeps in its cache folder, by objdump; 0 where
/// there are none, as with another driver.
std::size_t instruction_count(const std::filesystem::path& pocl_cache);

} // namespace reradiant
