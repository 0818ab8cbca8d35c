// Preloaded into the program by the tests of faults: the device and the clock as they are on a bad
// day. Environment variables say what fails; without them everything passes through.
//   RERADIANT_FAULT_LAUNCH=N   the device is gone at the Nth kernel launch and stays so
//   RERADIANT_FAULT_BUFFER=N   the Nth buffer is not allocated
//   RERADIANT_FAULT_BUILD=1    no kernel builds
//   RERADIANT_FAULT_RENAME=.x  no file is renamed to a name that ends so: the disk is full
//   RERADIANT_FAULT_CLOCK=1    the wall clock leaps by up to a day, back and forth, at every look

#include <CL/cl.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <dlfcn.h>
#include <string_view>
#include <sys/time.h>

namespace {

template <typename Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

long number_of(const char* variable) {
    const char* const text = std::getenv(variable);
    return text ? std::atol(text) : 0;
}

/// True from the call on whose number the variable holds.
bool has_failed(const char* variable, std::atomic<long>& calls) {
    const long first = number_of(variable);
    return first > 0 && ++calls >= first;
}

std::time_t leap() {
    static std::atomic<unsigned> looks{0};
    if (number_of("RERADIANT_FAULT_CLOCK") == 0)
        return 0;
    const unsigned mixed = (++looks * 2654435761u) >> 8;
    return static_cast<std::time_t>(mixed % 172800u) - 86400;
}

} // namespace

extern "C" {

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const std::size_t* offset, const std::size_t* global,
                              const std::size_t* local, cl_uint waits, const cl_event* wait_list,
                              cl_event* event) {
    static std::atomic<long> calls{0};
    static const auto real = next<decltype(&clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    if (has_failed("RERADIANT_FAULT_LAUNCH", calls))
        return CL_DEVICE_NOT_AVAILABLE;
    return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t size, void* host,
                      cl_int* error) {
    static std::atomic<long> calls{0};
    static const auto real = next<decltype(&clCreateBuffer)>("clCreateBuffer");
    if (!has_failed("RERADIANT_FAULT_BUFFER", calls))
        return real(context, flags, size, host, error);
    if (error)
        *error = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return nullptr;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                      const char* options, void(CL_CALLBACK* notify)(cl_program, void*),
                      void* data) {
    static const auto real = next<decltype(&clBuildProgram)>("clBuildProgram");
    if (number_of("RERADIANT_FAULT_BUILD") != 0)
        return CL_BUILD_PROGRAM_FAILURE;
    return real(program, count, devices, options, notify, data);
}

int rename(const char* from, const char* to) noexcept {
    static const auto real = next<int (*)(const char*, const char*)>("rename");
    const char* const ending = std::getenv("RERADIANT_FAULT_RENAME");
    if (ending == nullptr || !std::string_view(to).ends_with(ending))
        return real(from, to);
    errno = ENOSPC;
    return -1;
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
    static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
    const int result = real(clock, now);
    if (result == 0 && clock == CLOCK_REALTIME)
        now->tv_sec += leap();
    return result;
}

int gettimeofday(timeval* now, void* zone) noexcept {
    static const auto real = next<int (*)(timeval*, void*)>("gettimeofday");
    const int result = real(now, zone);
    if (result == 0)
        now->tv_sec += leap();
    return result;
}

std::time_t time(std::time_t* now) noexcept {
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    if (now)
        *now = wall.tv_sec;
    return wall.tv_sec;
}

} // extern "C"
