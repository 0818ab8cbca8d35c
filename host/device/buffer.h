#pragma once

#include "host/device/opencl_device.h"
#include "reradiant/device.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>

namespace reradiant {

/// A buffer, in memory that the host reaches without mapping where the device has such.
class DeviceStorage {
public:
    DeviceStorage(const Device& device, std::size_t bytes)
        : shared_(device.info().shares_memory ? shared_memory(device.opencl().context, bytes)
                                              : nullptr,
                  Release{device.opencl().context, device.opencl().queue}),
          buffer_(shared_
                      ? cl::Buffer(device.opencl().context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR,
                                   bytes, shared_.get())
                      : cl::Buffer(device.opencl().context,
                                   CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes)) {}

    const cl::Buffer& buffer() const { return buffer_; }
    /// Returns the shared memory that the buffer lies in, or null where the buffer must be mapped.
    void* shared() const { return shared_.get(); }

private:
    struct Release {
        cl::Context context;
        cl::CommandQueue queue;
        /// An error in the midst of a pass leaves kernels queued: buffers wait for them, this
        /// memory would not.
        void operator()(void* memory) const {
            clFinish(queue());
            clSVMFree(context(), memory);
        }
    };
    /// Returns null when there is no shared memory: then a buffer of the driver's may still fit, or
    /// say what is wrong.
    static void* shared_memory(const cl::Context& context, std::size_t bytes) {
        return clSVMAlloc(context(), CL_MEM_READ_WRITE | CL_MEM_SVM_FINE_GRAIN_BUFFER, bytes, 0);
    }

    std::unique_ptr<void, Release> shared_;
    cl::Buffer buffer_; // is destroyed before the memory that it lies in
};

/// An array that host and device use in turn. On devices that share memory with the host no data
/// moves. An array may go only when nothing that uses it is queued.
template <typename T>
class DeviceArray {
public:
    DeviceArray() = default;
    /// At least one element is allocated, so that the buffer can always be bound.
    DeviceArray(const Device& device, std::size_t count) : device_(&device), count_(count) {
        const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(T);
        check_allocation(device, bytes);
        storage_ = std::make_unique<DeviceStorage>(device, bytes);
    }
    DeviceArray(const Device& device, std::span<const T> values)
        : DeviceArray(device, values.size()) {
        if (!values.empty())
            device.opencl().queue.enqueueWriteBuffer(buffer(), CL_TRUE, 0, values.size_bytes(),
                                                     values.data());
    }

    const cl::Buffer& buffer() const { return storage_->buffer(); }
    std::size_t size() const { return count_; }
    std::size_t bytes() const { return count_ * sizeof(T); }

    void fill_zero() const {
        device_->opencl().queue.enqueueFillBuffer(buffer(), 0, 0,
                                                  std::max<std::size_t>(count_, 1) * sizeof(T));
    }

    /// Host view of [first, first + count) until destroyed. Waits for what was queued before.
    class Mapping {
    public:
        Mapping(const DeviceArray& array, std::size_t first, std::size_t count, cl_map_flags flags)
            : array_(array), count_(count) {
            const cl::CommandQueue& queue = array.device_->opencl().queue;
            if (is_shared()) {
                queue.finish();
                data_ = static_cast<T*>(array.storage_->shared()) + first;
            } else if (count > 0) { // an empty range cannot be mapped
                data_ = static_cast<T*>(queue.enqueueMapBuffer(
                    array.buffer(), CL_TRUE, flags, first * sizeof(T), count * sizeof(T)));
            }
        }
        ~Mapping() {
            if (!is_shared() && data_ != nullptr)
                clEnqueueUnmapMemObject(array_.device_->opencl().queue(), array_.buffer()(), data_,
                                        0, nullptr, nullptr);
        }
        Mapping(const Mapping&) = delete;
        Mapping& operator=(const Mapping&) = delete;
        std::span<T> span() const { return {data_, count_}; }

    private:
        bool is_shared() const { return array_.storage_->shared() != nullptr; }

        const DeviceArray& array_;
        std::size_t count_;
        T* data_ = nullptr;
    };
    Mapping map(cl_map_flags flags, std::size_t first, std::size_t count) const {
        return Mapping(*this, first, count, flags);
    }

private:
    const Device* device_ = nullptr;
    std::size_t count_ = 0;
    std::unique_ptr<DeviceStorage> storage_;
};

} // namespace reradiant
