#pragma once

#include "reradiant/layer_stack.h"
#include "reradiant/merge.h"
#include "reradiant/wavelength_grid.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace reradiant {

/// The checkpoint of work whose state is numbers (host/render/checkpoint/work_checkpoint.h): a file
/// beside the output, written every so many seconds and when somebody interrupts, removed when the
/// work is done.
class KeptWork {
public:
    /// No checkpoint is written beside an output that is a device or a pipe. `identity` says what
    /// the work depends on; the build is added here.
    KeptWork(const std::filesystem::path& output, SampleIdentity identity, double seconds);

    /// Gives `take` the state to go on from, where there is a checkpoint. Input Error for one that
    /// is damaged or of other work, naming what differs; those of `take` get the file's name.
    void resume(const std::function<void(const nlohmann::json&)>& take) const;
    /// Writes when it is time. Keeps the share of time that goes into writing below a tenth.
    void keep_when_due(const std::function<nlohmann::json()>& state);
    void remove() const;

    /// "interrupted; FILE holds what was done, --resume goes on", for standard error.
    std::string interruption_text() const;

private:
    std::filesystem::path file_; ///< empty: none
    SampleIdentity identity_;
    double seconds_, write_seconds_ = 0.0;
    std::chrono::steady_clock::time_point written_ = std::chrono::steady_clock::now();
};

/// Digests of a text, of a file's bytes, and of a stack's numbers at the bands.
std::string sha256_hex(const std::string& text);
std::string file_digest(const std::filesystem::path& file);
std::string stack_digest(const LayerStack& stack, const WavelengthGrid& bands);

} // namespace reradiant
