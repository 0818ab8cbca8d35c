#include "host/base/logging.h"
#include "host/device/device_checks.h"
#include "host/device/driver_list.h"
#include "host/report/json_file.h"
#include "reradiant/device.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

nlohmann::ordered_json to_json(const DeviceInfo& device) {
    return {{"index", device.index},
            {"name", device.name},
            {"platform", device.platform},
            {"driver", device.driver},
            {"version", device.version},
            {"type", device.type},
            {"compute_units", device.compute_units},
            {"memory_bytes", device.memory_bytes},
            {"max_allocation_bytes", device.max_allocation_bytes},
            {"local_memory_bytes", device.local_memory_bytes},
            {"max_work_group", device.max_work_group},
            {"double", device.has_double},
            {"check", device_check_text(device_check(device))}};
}

int run_devices(const CommonOptions& common) {
    check_outputs(common, {});
    prepare_opencl(common.threads);
    const std::vector<DeviceInfo> devices = list_devices();
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeviceInfo& device : devices) {
        list.push_back(to_json(device));
        fmt::print("{}: {} ({}, {}, {} units, {:.1f} GiB, {}; {})\n", device.index, device.name,
                   device.platform, device.type, device.compute_units,
                   static_cast<double>(device.memory_bytes) / (1024.0 * 1024.0 * 1024.0),
                   device.has_double ? "double" : "no double",
                   device_check_text(device_check(device)));
    }
    if (devices.empty())
        Device("0"); // throws the error that says what to install
    nlohmann::ordered_json absent = nlohmann::ordered_json::array();
    for (const AbsentDriver& driver : absent_drivers()) {
        logging::warn("{}", absent_driver_text(driver));
        absent.push_back(
            {{"file", driver.file}, {"library", driver.library}, {"reason", driver.reason}});
    }
    write_json(common.json, {{"devices", list}, {"not_loaded", absent}});
    return 0;
}

} // namespace

void add_devices_command(Program& program, CommandContext& context) {
    Command command = program.add_command(
        "devices", "Lists the OpenCL devices, and whether `check` passed on them");
    command.footer("Example: reradiant devices --json devices.json");
    command.callback([&context] { context.exit_code = run_devices(context.common); });
}

} // namespace reradiant
