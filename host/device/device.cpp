#include "reradiant/device.h"

#include "host/device/driver_cache.h"
#include "host/device/driver_list.h"
#include "host/device/opencl_device.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <unistd.h>

namespace reradiant {

namespace {

struct FoundDevice {
    DeviceInfo info;
    cl::Device device;
};

std::string type_name(cl_device_type type) {
    if (type & CL_DEVICE_TYPE_GPU)
        return "GPU";
    if (type & CL_DEVICE_TYPE_CPU)
        return "CPU";
    return type & CL_DEVICE_TYPE_ACCELERATOR ? "accelerator" : "custom";
}

bool shares_memory(const cl::Device& device, const std::string& version) {
    cl_device_svm_capabilities capabilities = 0;
    return version.rfind("OpenCL 1", 0) != 0 &&
           clGetDeviceInfo(device(), CL_DEVICE_SVM_CAPABILITIES, sizeof(capabilities),
                           &capabilities, nullptr) == CL_SUCCESS &&
           (capabilities & CL_DEVICE_SVM_FINE_GRAIN_BUFFER) != 0;
}

DeviceInfo describe(const cl::Platform& platform, const cl::Device& device, int index) {
    DeviceInfo info;
    info.index = index;
    info.name = device.getInfo<CL_DEVICE_NAME>();
    info.platform = platform.getInfo<CL_PLATFORM_NAME>();
    info.driver = device.getInfo<CL_DRIVER_VERSION>();
    info.version = device.getInfo<CL_DEVICE_VERSION>();
    info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.local_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    info.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    info.shares_memory = shares_memory(device, info.version);
    info.has_double =
        device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    return info;
}

std::vector<FoundDevice> find_devices() {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {}; // the loader reports "no platform" as an error
    }
    std::vector<FoundDevice> found;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error&) {
            continue; // a platform without devices
        }
        for (const cl::Device& device : devices)
            found.push_back({describe(platform, device, static_cast<int>(found.size())), device});
    }
    return found;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool fits(const DeviceInfo& info, const std::string& wanted) {
    int index = -1;
    const auto [end, code] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (code == std::errc{} && end == wanted.data() + wanted.size())
        return info.index == index;
    return lower(info.name).find(lower(wanted)) != std::string::npos;
}

[[noreturn]] void throw_no_device() {
    std::string what = "no OpenCL device was found";
    for (const AbsentDriver& driver : absent_drivers())
        what += "; " + absent_driver_text(driver);
    if (const std::string problem = driver_cache_problem(); !problem.empty())
        throw_runtime_error(what + "; " + problem, "set RERADIANT_CACHE to a folder that can be "
                                                   "written to");
    throw_runtime_error(what, "install a driver, for instance the package pocl-opencl-icd");
}

FoundDevice choose(const std::string& wanted) {
    const std::vector<FoundDevice> found = find_devices();
    if (found.empty())
        throw_no_device();
    std::string names;
    for (const FoundDevice& candidate : found) {
        if (wanted.empty() || fits(candidate.info, wanted))
            return candidate;
        names += fmt::format("{}{}: {}", names.empty() ? "" : ", ", candidate.info.index,
                             candidate.info.name);
    }
    throw_runtime_error(fmt::format("no OpenCL device fits '{}'", wanted),
                        "choose one of " + names);
}

/// Tells hwloc about memory and cores if /sys is not mounted (bare chroots, some containers): it
/// would find neither, and PoCL would abort the process.
void describe_machine_without_sys() {
    std::error_code ignored;
    if (std::filesystem::is_directory("/sys/devices/system/cpu", ignored))
        return;
    const std::string machine =
        fmt::format("node:1(memory={}) pu:{}",
                    static_cast<long long>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGE_SIZE),
                    ::sysconf(_SC_NPROCESSORS_ONLN));
    ::setenv("HWLOC_SYNTHETIC", machine.c_str(), 0);
    ::setenv("HWLOC_THISSYSTEM", "1", 0);
}

[[noreturn]] void throw_beyond(const Device& device, const std::string& needed,
                               const std::string& most) {
    throw_runtime_error(fmt::format("{}, the OpenCL device '{}' allocates at most {}", needed,
                                    device.info().name, most),
                        "make the film smaller, take fewer bands or another --device");
}

} // namespace

void prepare_opencl(int threads) {
    describe_machine_without_sys();
    prepare_driver_cache();
    if (threads > 0)
        ::setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(threads).c_str(), 1);
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const FoundDevice& found : find_devices())
        infos.push_back(found.info);
    return infos;
}

std::optional<LoadedPrograms::Entry> LoadedPrograms::find(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(key);
    return entry == entries_.end() ? std::nullopt : std::optional(entry->second);
}

void LoadedPrograms::add(const std::string& key, const Entry& entry) {
    const std::lock_guard lock(mutex_);
    entries_.emplace(key, entry);
}

Device::Device(const std::string& name_or_index, bool may_share_memory) {
    opencl_checked("opening the device", [&] {
        FoundDevice found = choose(name_or_index);
        info_ = found.info;
        info_.shares_memory = info_.shares_memory && may_share_memory;
        opencl_ = std::make_shared<OpenClDevice>();
        opencl_->handle = found.device;
        opencl_->context = cl::Context(found.device);
        opencl_->queue =
            cl::CommandQueue(opencl_->context, found.device, CL_QUEUE_PROFILING_ENABLE);
    });
}

void check_allocation(const Device& device, std::size_t bytes) {
    if (bytes > device.info().max_allocation_bytes)
        throw_beyond(device, fmt::format("an array of {} bytes is needed", bytes),
                     fmt::format("{} at once", device.info().max_allocation_bytes));
}

void check_memory(const Device& device, std::size_t bytes) {
    if (bytes > device.info().memory_bytes)
        throw_beyond(device, fmt::format("arrays of {} bytes are needed", bytes),
                     fmt::format("{} in all", device.info().memory_bytes));
}

void check_double(const DeviceInfo& device) {
    if (!device.has_double)
        throw_input_error({"--double"},
                          fmt::format("the device '{}' has no double precision", device.name),
                          "take another --device, or leave --double out");
}

void opencl_checked(const std::string& what, const std::function<void()>& action) {
    try {
        action();
    } catch (const cl::Error& error) {
        throw_runtime_error(fmt::format("{} failed on the OpenCL device: {} returned {}", what,
                                        error.what(), opencl_error_name(error.err())));
    }
}

std::string opencl_error_name(int code) {
    static const std::map<int, const char*> names = {
        {-1, "CL_DEVICE_NOT_FOUND"},
        {-2, "CL_DEVICE_NOT_AVAILABLE"},
        {-4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
        {-5, "CL_OUT_OF_RESOURCES"},
        {-6, "CL_OUT_OF_HOST_MEMORY"},
        {-11, "CL_BUILD_PROGRAM_FAILURE"},
        {-30, "CL_INVALID_VALUE"},
        {-42, "CL_INVALID_BINARY"},
        {-43, "CL_INVALID_BUILD_OPTIONS"},
        {-44, "CL_INVALID_PROGRAM"},
        {-45, "CL_INVALID_PROGRAM_EXECUTABLE"},
        {-46, "CL_INVALID_KERNEL_NAME"},
        {-48, "CL_INVALID_KERNEL"},
        {-50, "CL_INVALID_ARG_VALUE"},
        {-51, "CL_INVALID_ARG_SIZE"},
        {-52, "CL_INVALID_KERNEL_ARGS"},
        {-54, "CL_INVALID_WORK_GROUP_SIZE"},
        {-55, "CL_INVALID_WORK_ITEM_SIZE"},
        {-61, "CL_INVALID_BUFFER_SIZE"},
        {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
    };
    const auto found = names.find(code);
    return found == names.end() ? fmt::format("error {}", code) : found->second;
}

} // namespace reradiant
