#pragma once

#include "reradiant/interruption.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <utility>

namespace reradiant::python {

/// Sends what the library logs to Python's logger "reradiant".
void install_log();

/// Hands what was logged since to that logger; for short work, which no thread of its own does.
/// Called with the GIL.
void pass_messages_on();

/// Runs `work` on a thread of its own, without the GIL, while this one lets Python handle signals:
/// the first Ctrl-C sets the flag, and KeyboardInterrupt is raised when the work has ended. What
/// `work` throws is thrown here. Called and left with the GIL.
void run_interruptible(const std::function<void(StopFlag)>& work);

/// Runs `work` as run_interruptible does, and returns its result.
template <typename Work>
auto interruptible(Work&& work) {
    std::optional<decltype(work(StopFlag{}))> result;
    run_interruptible([&](StopFlag stop) { result.emplace(work(stop)); });
    return std::move(*result);
}

} // namespace reradiant::python
