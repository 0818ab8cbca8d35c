#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace reradiant {

struct OpenClDevice; // host/device/opencl_device.h

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

/// A device with one in-order queue that takes the time of what it runs.
class Device {
public:
    /// Opens a device by its index or by a part of its name (case-insensitive), or the first one
    /// when that is empty. Throws a run-time Error that lists the devices when there is none, or
    /// none that fits. Without `may_share_memory` arrays are mapped also where that is not needed.
    explicit Device(const std::string& name_or_index, bool may_share_memory = true);

    const DeviceInfo& info() const { return info_; }
    /// The OpenCL objects, for code that queues work.
    OpenClDevice& opencl() const { return *opencl_; }

private:
    DeviceInfo info_;
    std::shared_ptr<OpenClDevice> opencl_;
};

/// Names and values that specialise a program, passed as #define.
using KernelDefines = std::vector<std::pair<std::string, long>>;

/// `BuildStatistics` says what it took to build the programs of a scene.
struct BuildStatistics {
    int built = 0, from_cache = 0;
    double seconds = 0.0;
    std::size_t source_bytes = 0; ///< before the compiler leaves anything out
    KernelDefines defines;        ///< of the last program
    std::size_t binary_bytes = 0; ///< of the programs as the driver keeps them
};

} // namespace reradiant
