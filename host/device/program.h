#pragma once

#include "host/device/opencl_device.h"
#include "host/device/source.h"

#include <cstddef>
#include <string>

namespace reradiant {

/// Builds a kernel file ("kernels/gather.cl") for a device, or takes it from those that the
/// device has loaded or from the disk cache, whose key is the source, the defines, the device and
/// the driver, and whose entries carry a checksum: a damaged entry is rebuilt, never loaded. A
/// failed build throws a run-time Error with the compiler's log and leaves the whole source in the
/// cache folder.
cl::Program build_program(const Device& device, const std::string& file,
                          const KernelDefines& defines, BuildStatistics* statistics = nullptr);

/// Builds a program as `build_program` does, from a source text that is no file.
cl::Program build_program_from_text(const Device& device, const std::string& name,
                                    const std::string& text, const KernelDefines& defines,
                                    BuildStatistics* statistics = nullptr);

/// A kernel with its launch size. Arguments are bound in order by one call.
class Kernel {
public:
    Kernel() = default;
    /// Takes the kernel `name` with groups of `local_size` work-items, or of as many as the device
    /// can do for it.
    Kernel(const cl::Program& program, const char* name, std::size_t local_size);

    template <typename... Arguments>
    void bind(const Arguments&... arguments) {
        cl_uint index = 0;
        (kernel_.setArg(index++, arguments), ...);
    }

    /// Queues at least `items` work-items (rounded up to whole groups; kernels check the range).
    /// The event says when they ran.
    cl::Event launch(const Device& device, std::size_t items) const;
    std::size_t local_size() const { return local_size_; }
    const cl::Kernel& handle() const { return kernel_; }

private:
    cl::Kernel kernel_;
    std::size_t local_size_ = 1;
};

} // namespace reradiant
