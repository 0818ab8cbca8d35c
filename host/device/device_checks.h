#pragma once

#include "reradiant/device.h"

#include <string>

namespace reradiant {

/// What is known of `check` on a device. Results are remembered in the disk cache by platform,
/// name, driver and version: another driver is another device.
enum class DeviceCheck {
    Never,
    Passed,
    Failed,
    OfProject ///< not checked here, but its driver is one that the project's own tests run on
};

DeviceCheck device_check(const DeviceInfo& device);

/// "check passed", "check FAILED", ...
std::string device_check_text(DeviceCheck check);

/// Remembers how a whole check ended. Where the cache cannot be written nothing is remembered.
void remember_device_check(const DeviceInfo& device, bool has_passed);

/// A warning for a device on which `check` never passed; empty where it did, or where the warning
/// was given before.
std::string unchecked_device_warning(const DeviceInfo& device);

} // namespace reradiant
