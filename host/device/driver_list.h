#pragma once

#include <string>
#include <vector>

namespace reradiant {

/// An OpenCL driver that is installed but offers no platform in this process.
struct AbsentDriver {
    std::string file;    ///< file that registers it, such as /etc/OpenCL/vendors/pocl.icd
    std::string library; ///< that the file names
    std::string reason;
};

/// The drivers that the OpenCL loader passes over without a word: those of /etc/OpenCL/vendors, or
/// of where $OCL_ICD_VENDORS, $OPENCL_VENDOR_PATH or $OCL_ICD_FILENAMES point, whose library does
/// not load, is no driver, or has no platform. To be asked after the loader has looked.
std::vector<AbsentDriver> absent_drivers();

/// "the OpenCL driver LIBRARY of FILE did not load: REASON"
std::string absent_driver_text(const AbsentDriver& driver);

} // namespace reradiant
