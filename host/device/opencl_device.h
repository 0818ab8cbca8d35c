#pragma once

#include "reradiant/device.h"

#include <CL/opencl.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace reradiant {

/// Programs of a device by the digest of all that they are built from: loading a program anew, even
/// from a cache on disk, takes longer than rendering a small picture. May be used by several
/// threads.
class LoadedPrograms {
public:
    struct Entry {
        cl::Program program;
        std::size_t binary_bytes = 0;
    };
    std::optional<Entry> find(const std::string& key) const;
    void add(const std::string& key, const Entry& entry);

private:
    mutable std::mutex mutex_;
    std::map<std::string, Entry> entries_;
};

/// The OpenCL objects of a Device.
struct OpenClDevice {
    cl::Device handle;
    cl::Context context;
    cl::CommandQueue queue; ///< in order, with profiling
    LoadedPrograms programs;
};

/// Run-time Error when the device cannot allocate so much in one piece.
void check_allocation(const Device& device, std::size_t bytes);
/// Run-time Error when arrays of so many bytes together are more than the device's memory.
void check_memory(const Device& device, std::size_t bytes);

/// Input Error of the option --double when the device computes in single precision only.
void check_double(const DeviceInfo& device);

/// Runs `action`; an OpenCL error becomes a run-time Error that names `what` and the code.
void opencl_checked(const std::string& what, const std::function<void()>& action);
/// "CL_INVALID_WORK_GROUP_SIZE" and so on; "error -123" for unknown codes.
std::string opencl_error_name(int code);

} // namespace reradiant
