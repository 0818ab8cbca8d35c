#include "host/device/program.h"

#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/device/program_cache.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr const char* build_options = "-cl-std=CL1.2 -Werror";

bool load_binary(const Device& device, const std::string& binary, cl::Program& program) {
    try {
        const cl::Program::Binaries binaries{
            std::vector<unsigned char>(binary.begin(), binary.end())};
        program = cl::Program(device.opencl().context, {device.opencl().handle}, binaries);
        program.build({device.opencl().handle}, build_options);
        return true;
    } catch (const cl::Error& error) {
        logging::debug("cached kernel refused by the driver: {}", opencl_error_name(error.err()));
        return false;
    }
}

/// A driver that fails may have no log either.
std::string build_log(const Device& device, const cl::Program& program) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.opencl().handle);
    } catch (const cl::Error& error) {
        return "the driver has no log: " + opencl_error_name(error.err());
    }
}

[[noreturn]] void report_failed_build(const Device& device, const cl::Program& program,
                                      const std::string& file, const std::string& source) {
    const fs::path dump = cache_directory() / ("failed-" + fs::path(file).filename().string());
    std::string where = "the whole source is in " + dump.string();
    try {
        fs::create_directories(dump.parent_path());
        write_text_atomically(dump, source);
    } catch (const std::exception& error) {
        where = fmt::format("its source could not be written: {}", error.what());
    }
    throw_runtime_error(fmt::format("{} does not build on '{}':\n{}", file, device.info().name,
                                    build_log(device, program)),
                        where);
}

/// Writes the program's binary to the cache and returns its size.
std::size_t keep(const cl::Program& program, const fs::path& file) {
    try {
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        if (binaries.empty() || binaries[0].empty())
            return 0;
        write_cached_program(file, std::string(binaries[0].begin(), binaries[0].end()));
        return binaries[0].size();
    } catch (const std::exception& error) {
        logging::debug("kernel not cached: {}", error.what()); // a cache is a convenience
        return 0;
    }
}

cl::Program compile(const Device& device, const std::string& file, const std::string& source) {
    cl::Program program(device.opencl().context, source);
    try {
        program.build({device.opencl().handle}, build_options);
    } catch (const cl::Error&) {
        report_failed_build(device, program, file, source);
    }
    return program;
}

/// From the cache on disk, or compiled; says which.
std::pair<LoadedPrograms::Entry, bool> load_or_compile(const Device& device,
                                                       const std::string& file,
                                                       const std::string& source,
                                                       const std::string& key) {
    const std::string binary = read_cached_program(cached_program_file(key));
    cl::Program program;
    if (!binary.empty() && load_binary(device, binary, program))
        return {{program, binary.size()}, true};
    program = compile(device, file, source);
    return {{program, keep(program, cached_program_file(key))}, false};
}

/// `source` is complete; `file` is what it is called.
cl::Program build_source(const Device& device, const std::string& file, const std::string& source,
                         BuildStatistics* statistics) {
    const auto start = std::chrono::steady_clock::now();
    const DeviceInfo& info = device.info();
    const std::string key =
        text_digest(fmt::format("{}\n{}\n{}\n{}\n{}\n{}", source, build_options, info.name,
                                info.platform, info.driver, info.version));
    std::optional<LoadedPrograms::Entry> entry = device.opencl().programs.find(key);
    bool cached = entry.has_value();
    if (!entry) {
        std::tie(entry, cached) = load_or_compile(device, file, source, key);
        device.opencl().programs.add(key, *entry);
    }
    if (statistics) {
        ++(cached ? statistics->from_cache : statistics->built);
        statistics->source_bytes += source.size();
        statistics->binary_bytes += entry->binary_bytes;
        statistics->seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return entry->program;
}

} // namespace

cl::Program build_program(const Device& device, const std::string& file,
                          const KernelDefines& defines, BuildStatistics* statistics) {
    if (statistics)
        statistics->defines = defines;
    return build_source(device, file, kernel_source(data_directory(), file, defines), statistics);
}

cl::Program build_program_from_text(const Device& device, const std::string& name,
                                    const std::string& text, const KernelDefines& defines,
                                    BuildStatistics* statistics) {
    return build_source(device, name, kernel_source_of_text(data_directory(), name, text, defines),
                        statistics);
}

Kernel::Kernel(const cl::Program& program, const char* name, std::size_t local_size)
    : kernel_(program, name) {
    const cl::Device device = program.getInfo<CL_PROGRAM_DEVICES>().front();
    local_size_ = std::min({local_size, device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(),
                            device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>().front(),
                            kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device)});
}

cl::Event Kernel::launch(const Device& device, std::size_t items) const {
    const std::size_t groups = (items + local_size_ - 1) / local_size_;
    cl::Event event;
    device.opencl().queue.enqueueNDRangeKernel(kernel_, cl::NullRange,
                                               cl::NDRange(groups * local_size_),
                                               cl::NDRange(local_size_), nullptr, &event);
    return event;
}

} // namespace reradiant
