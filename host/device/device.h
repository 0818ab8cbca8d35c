#pragma once

#include <CL/opencl.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct DeviceInfo {
    int index = 0; ///< position in the list, what --device takes
    std::string name, platform, driver, version, type;
    unsigned compute_units = 0;
    std::uint64_t memory_bytes = 0, max_allocation_bytes = 0, local_memory_bytes = 0;
    std::size_t max_work_group = 0;
    bool has_double = false;
    bool shares_memory = false; ///< with the host, without mapping (fine-grained SVM, OpenCL 2)
};

/// Before the first OpenCL call of the process: gives PoCL a cache folder of this program's own
/// and as many threads as asked (0: all). Later calls change nothing.
void prepare_opencl(int threads);

/// Every OpenCL device of every platform. Empty when there is none.
std::vector<DeviceInfo> list_devices();

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

/// A device with one in-order queue that takes the time of what it runs.
class Device {
public:
    /// Opens a device by its index or by a part of its name (case-insensitive), or the first one
    /// when that is empty. Throws a run-time Error that lists the devices when there is none, or
    /// none that fits. Without `may_share_memory` arrays are mapped also where that is not needed.
    explicit Device(const std::string& name_or_index, bool may_share_memory = true);

    const DeviceInfo& info() const { return info_; }
    const cl::Device& handle() const { return device_; }
    const cl::Context& context() const { return context_; }
    const cl::CommandQueue& queue() const { return queue_; }
    LoadedPrograms& programs() const { return *programs_; }

private:
    DeviceInfo info_;
    cl::Device device_;
    cl::Context context_;
    cl::CommandQueue queue_;
    std::shared_ptr<LoadedPrograms> programs_ = std::make_shared<LoadedPrograms>();
};

/// Throws a run-time Error when the device cannot allocate so much in one piece.
void check_allocation(const Device& device, std::size_t bytes);
/// Throws a run-time Error when arrays of so many bytes together are more than the device's memory.
void check_memory(const Device& device, std::size_t bytes);

/// Throws an input Error of the option --double when the device computes in single precision only.
void check_double(const DeviceInfo& device);

/// Runs `action`; an OpenCL error becomes a run-time Error that names `what` and the code.
void opencl_checked(const std::string& what, const std::function<void()>& action);
/// "CL_INVALID_WORK_GROUP_SIZE" and so on; "error -123" for unknown codes.
std::string opencl_error_name(int code);

} // namespace reradiant
