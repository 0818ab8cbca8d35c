#pragma once

#include "reradiant/device.h"

#include <filesystem>
#include <string>

namespace reradiant {

/// Returns a kernel file ("kernels/gather.cl", relative to `root`) with its headers (`#include
/// "kernels/..."`) put in place, each once, and #line directives so that the compiler's messages
/// name the real files. Throws a run-time Error when a file is missing.
std::string kernel_source(const std::filesystem::path& root, const std::string& file,
                          const KernelDefines& defines);

/// Returns the source as `kernel_source` does, from a text that is no file; the compiler's messages
/// call it `name`.
std::string kernel_source_of_text(const std::filesystem::path& root, const std::string& name,
                                  const std::string& text, const KernelDefines& defines);

/// 64 bit FNV-1a of a text, 16 hex digits.
std::string text_digest(const std::string& text);

} // namespace reradiant
