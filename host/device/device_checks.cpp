#include "host/device/device_checks.h"

#include "host/base/atomic_file.h"
#include "host/base/regular_file.h"
#include "host/device/source.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <string_view>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view passed = "passed", failed = "failed", warned = "warned";

/// A platform and what its driver's version begins with.
struct TestedDriver {
    std::string_view platform, driver;
};
constexpr std::array tested_drivers = {TestedDriver{"Portable Computing Language", "3.1"},
                                       TestedDriver{"Portable Computing Language", "6."}};

fs::path record_file(const DeviceInfo& device) {
    const std::string key = fmt::format("{}\n{}\n{}\n{}\n", device.platform, device.name,
                                        device.driver, device.version);
    return cache_directory() / "devices" / (text_digest(key) + ".txt");
}

/// The word that is remembered; empty where nothing is.
std::string remembered(const DeviceInfo& device) {
    std::ifstream stream = open_regular_file(record_file(device));
    std::string word;
    stream >> word;
    return word;
}

void remember(const DeviceInfo& device, std::string_view word) {
    try {
        const fs::path file = record_file(device);
        fs::create_directories(file.parent_path());
        write_text_atomically(file, fmt::format("{}\n{}\n{}\n{}\n", word, device.platform,
                                                device.name, device.driver));
    } catch (const std::exception&) {
        // The next run asks again.
    }
}

bool is_tested(const DeviceInfo& device) {
    return std::any_of(
        tested_drivers.begin(), tested_drivers.end(), [&](const TestedDriver& tested) {
            return device.platform == tested.platform && device.driver.starts_with(tested.driver);
        });
}

} // namespace

DeviceCheck device_check(const DeviceInfo& device) {
    const std::string word = remembered(device);
    if (word == passed)
        return DeviceCheck::Passed;
    if (word == failed)
        return DeviceCheck::Failed;
    return is_tested(device) ? DeviceCheck::OfProject : DeviceCheck::Never;
}

std::string device_check_text(DeviceCheck check) {
    switch (check) {
    case DeviceCheck::Passed:
        return "check passed";
    case DeviceCheck::Failed:
        return "check FAILED";
    case DeviceCheck::OfProject:
        return "not checked here, a driver of the project's own tests";
    case DeviceCheck::Never:
        break;
    }
    return "never checked";
}

void remember_device_check(const DeviceInfo& device, bool has_passed) {
    remember(device, has_passed ? passed : failed);
}

std::string unchecked_device_warning(const DeviceInfo& device) {
    const DeviceCheck check = device_check(device);
    if (check == DeviceCheck::Failed)
        return fmt::format("`reradiant check` failed on '{}' ({} {})", device.name, device.platform,
                           device.driver);
    if (check != DeviceCheck::Never || remembered(device) == warned)
        return {};
    remember(device, warned);
    return fmt::format("'{}' ({} {}) was never checked; `reradiant check` says in a minute whether "
                       "its numbers are right",
                       device.name, device.platform, device.driver);
}

} // namespace reradiant
