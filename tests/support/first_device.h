#pragma once

#include "reradiant/device.h"

namespace reradiant::test {

/// The first OpenCL device, opened once in a process.
inline const Device& device() {
    static const Device opened = [] {
        prepare_opencl(0);
        return Device("");
    }();
    return opened;
}

} // namespace reradiant::test
