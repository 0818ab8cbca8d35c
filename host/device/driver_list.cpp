#include "host/device/driver_list.h"

#include "host/base/regular_file.h"
#include "host/device/opencl_device.h"
#include "reradiant/device.h"

#include <CL/cl_ext.h>

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

/// Returns the files that register drivers: .icd files, or libraries where a variable names them
/// outright.
std::vector<fs::path> registrations() {
    std::vector<fs::path> found;
    fs::path place = "/etc/OpenCL/vendors";
    for (const char* variable : {"OPENCL_VENDOR_PATH", "OCL_ICD_VENDORS"}) // the second one wins
        if (const std::string named = environment(variable); !named.empty())
            place = named;
    std::error_code ignored;
    if (fs::is_directory(place, ignored)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored))
            if (entry.path().extension() == ".icd")
                found.push_back(entry.path());
        std::sort(found.begin(), found.end());
    } else if (place != "/etc/OpenCL/vendors") {
        found.push_back(place);
    }
    const std::string files = environment("OCL_ICD_FILENAMES");
    for (std::size_t start = 0; start < files.size();) {
        const std::size_t end = std::min(files.find(':', start), files.size());
        if (end > start)
            found.emplace_back(files.substr(start, end - start));
        start = end + 1;
    }
    return found;
}

/// Returns the library that a registration names: the first line of an .icd file; anything else is
/// a library itself.
std::string library_of(const fs::path& registration) {
    if (registration.extension() != ".icd")
        return registration.string();
    std::string line;
    std::ifstream stream = open_regular_file(registration);
    std::getline(stream, line);
    const std::size_t last = line.find_last_not_of(" \t\r");
    return last == std::string::npos ? "" : line.substr(0, last + 1);
}

/// Returns why the library offers no platform, or nothing when it does. The loader asks the same
/// two functions.
std::string why_absent(const std::string& library) {
    // Never closed: a driver may have left threads behind.
    void* const handle = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* const reason = ::dlerror();
        return reason != nullptr ? reason : "it cannot be loaded";
    }
    const auto address_of =
        reinterpret_cast<void* (*)(const char*)>(::dlsym(handle, "clGetExtensionFunctionAddress"));
    const auto platforms = reinterpret_cast<clIcdGetPlatformIDsKHR_fn>(
        address_of ? address_of("clIcdGetPlatformIDsKHR") : nullptr);
    if (platforms == nullptr)
        return "it is no OpenCL driver";
    cl_uint count = 0;
    const cl_int code = platforms(0, nullptr, &count);
    if (code != CL_SUCCESS)
        return fmt::format("it has no platform: {}", opencl_error_name(code));
    return count == 0 ? "it has no platform" : "";
}

} // namespace

std::vector<AbsentDriver> absent_drivers() {
    std::vector<AbsentDriver> absent;
    for (const fs::path& registration : registrations()) {
        const std::string library = library_of(registration);
        const std::string reason = library.empty() ? "it names no library" : why_absent(library);
        if (!reason.empty())
            absent.push_back({registration.string(), library, reason});
    }
    return absent;
}

std::string absent_driver_text(const AbsentDriver& driver) {
    return fmt::format("the OpenCL driver {} of {} did not load: {}",
                       driver.library.empty() ? "(none named)" : driver.library, driver.file,
                       driver.reason);
}

} // namespace reradiant
