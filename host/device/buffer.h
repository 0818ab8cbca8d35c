#pragma once

#include "host/device/device.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace reradiant {

/// An array that host and device use in turn. On devices that share memory with the host the
/// mapping moves no data (CL_MEM_ALLOC_HOST_PTR).
template <typename T>
class DeviceArray {
public:
    DeviceArray() = default;
    /// At least one element is allocated, so that the buffer can always be bound.
    DeviceArray(const Device& device, std::size_t count) : device_(&device), count_(count) {
        const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(T);
        check_allocation(device, bytes);
        buffer_ = cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes);
    }
    DeviceArray(const Device& device, std::span<const T> values)
        : DeviceArray(device, values.size()) {
        if (!values.empty())
            device.queue().enqueueWriteBuffer(buffer_, CL_TRUE, 0, values.size_bytes(),
                                              values.data());
    }

    const cl::Buffer& buffer() const { return buffer_; }
    std::size_t size() const { return count_; }
    std::size_t bytes() const { return count_ * sizeof(T); }

    void fill_zero() const {
        device_->queue().enqueueFillBuffer(buffer_, 0, 0,
                                           std::max<std::size_t>(count_, 1) * sizeof(T));
    }

    /// Host view of [first, first + count) until destroyed. Waits for what was queued before.
    class Mapping {
    public:
        Mapping(const DeviceArray& array, std::size_t first, std::size_t count, cl_map_flags flags)
            : array_(array), count_(count),
              data_(static_cast<T*>(array.device_->queue().enqueueMapBuffer(
                  array.buffer_, CL_TRUE, flags, first * sizeof(T), count * sizeof(T)))) {}
        ~Mapping() {
            clEnqueueUnmapMemObject(array_.device_->queue()(), array_.buffer_(), data_, 0, nullptr,
                                    nullptr);
        }
        Mapping(const Mapping&) = delete;
        Mapping& operator=(const Mapping&) = delete;
        std::span<T> span() const { return {data_, count_}; }

    private:
        const DeviceArray& array_;
        std::size_t count_;
        T* data_;
    };
    Mapping map(cl_map_flags flags, std::size_t first, std::size_t count) const {
        return Mapping(*this, first, count, flags);
    }

private:
    const Device* device_ = nullptr;
    std::size_t count_ = 0;
    cl::Buffer buffer_;
};

} // namespace reradiant
