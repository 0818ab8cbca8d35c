// Preloaded into the program under Oclgrind 21.10, which does not note what the host writes by
// clEnqueueFillBuffer or into a part of a buffer, and then reports what kernels read there as not
// initialised. Where the program does so, the whole buffer is written again as it is. With
// RERADIANT_SIMULATED_CPU set the simulator, which calls itself a GPU, calls itself a CPU, for
// which kernels are built in another way.
#include <CL/cl.h>
#include <dlfcn.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <vector>

namespace {

template <typename Function>
Function real_function(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Mappings that the host may write to, by their address; those that begin with their buffer are
/// noted by the simulator itself.
std::mutex guard;
std::set<void*> written_parts;

void write_as_it_is(cl_command_queue queue, cl_mem buffer) {
    std::size_t size = 0;
    clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof size, &size, nullptr);
    std::vector<unsigned char> bytes(size);
    clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, size, bytes.data(), 0, nullptr, nullptr);
    clEnqueueWriteBuffer(queue, buffer, CL_TRUE, 0, size, bytes.data(), 0, nullptr, nullptr);
}

} // namespace

extern "C" {

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, std::size_t size, void* value,
                       std::size_t* size_needed) {
    static const auto info = real_function<decltype(&clGetDeviceInfo)>("clGetDeviceInfo");
    const cl_int result = info(device, what, size, value, size_needed);
    if (result == CL_SUCCESS && what == CL_DEVICE_TYPE && value != nullptr &&
        std::getenv("RERADIANT_SIMULATED_CPU") != nullptr)
        *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_CPU;
    return result;
}

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                           std::size_t pattern_size, std::size_t offset, std::size_t size,
                           cl_uint wait_count, const cl_event* waits, cl_event* event) {
    std::vector<unsigned char> bytes(size);
    for (std::size_t k = 0; k < size; k += pattern_size)
        std::memcpy(bytes.data() + k, pattern, pattern_size);
    return clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, size, bytes.data(), wait_count,
                                waits, event);
}

void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool is_blocking,
                         cl_map_flags flags, std::size_t offset, std::size_t size,
                         cl_uint wait_count, const cl_event* waits, cl_event* event,
                         cl_int* error) {
    static const auto map = real_function<decltype(&clEnqueueMapBuffer)>("clEnqueueMapBuffer");
    void* const data =
        map(queue, buffer, is_blocking, flags, offset, size, wait_count, waits, event, error);
    if (data != nullptr && offset > 0 && flags == CL_MAP_WRITE) {
        const std::lock_guard lock(guard);
        written_parts.insert(data);
    }
    return data;
}

cl_int clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem buffer, void* data,
                               cl_uint wait_count, const cl_event* waits, cl_event* event) {
    static const auto unmap =
        real_function<decltype(&clEnqueueUnmapMemObject)>("clEnqueueUnmapMemObject");
    bool is_part = false;
    {
        const std::lock_guard lock(guard);
        is_part = written_parts.erase(data) > 0;
    }
    const cl_int result = unmap(queue, buffer, data, wait_count, waits, event);
    if (result == CL_SUCCESS && is_part)
        write_as_it_is(queue, buffer);
    return result;
}

} // extern "C"
