#include "tools/program/kept_work.h"

#include "host/layers/stack/slab_emission.h"
#include "host/render/checkpoint/render_identity.h"
#include "host/render/checkpoint/work_checkpoint.h"
#include "host/scene/model/sha256.h"
#include "reradiant/error.h"
#include "reradiant/stack_elements.h"
#include "tools/program/interrupt.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace reradiant {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string text_of(const SurfaceValues& surface) {
    return fmt::format("surface {} {} {} {} {} {} {} {} {}", surface.ior_above, surface.ior_below,
                       surface.kappa, surface.is_conductor, static_cast<int>(surface.distribution),
                       surface.alpha, static_cast<int>(surface.scattering),
                       surface.film.thickness_nm, surface.film.ior);
}
std::string text_of(const SlabValues& slab) {
    return fmt::format("slab {} {} {} {} {}", slab.ior, slab.tau, slab.tau_scattering,
                       slab.anisotropy, slab.tau_dyes);
}
std::string text_of(const FlakesValues& flakes) {
    return fmt::format("flakes {} {}", flakes.coverage, text_of(flakes.reflector));
}
std::string text_of(const DiffuseValues& substrate) {
    return fmt::format("diffuse {}", substrate.sigma);
}

} // namespace

KeptWork::KeptWork(const fs::path& output, SampleIdentity identity, double seconds)
    : identity_(std::move(identity)), seconds_(seconds) {
    identity_.push_back({"build", build_digest()});
    file_ = checkpoint_beside(output);
}

void KeptWork::resume(const std::function<void(const Json&)>& take) const {
    std::error_code ignored;
    if (file_.empty() || !fs::exists(file_, ignored))
        return;
    const Json state = read_work_checkpoint(file_, identity_);
    try {
        take(state);
    } catch (const Error& error) {
        throw_input_error({file_.string()}, error.what());
    }
}

void KeptWork::keep_when_due(const std::function<Json()>& state) {
    if (file_.empty() || (!interrupt_requested() &&
                          seconds_since(written_) < std::max(seconds_, 10.0 * write_seconds_)))
        return;
    const Clock::time_point start = Clock::now();
    write_work_checkpoint(file_, identity_, state());
    written_ = Clock::now();
    write_seconds_ = seconds_since(start);
}

void KeptWork::remove() const {
    std::error_code ignored;
    if (!file_.empty())
        fs::remove(file_, ignored);
}

std::string KeptWork::interruption_text() const {
    std::error_code ignored;
    return fs::exists(file_, ignored)
               ? fmt::format("interrupted; {} holds what was done, --resume goes on",
                             file_.string())
               : "interrupted; nothing was written";
}

std::string sha256_hex(const std::string& text) {
    Sha256 sha;
    sha.update(text);
    return sha.hex();
}

std::string file_digest(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return sha256_hex(text.str());
}

std::string stack_digest(const LayerStack& stack, const WavelengthGrid& bands) {
    std::string text;
    for (const double nm : bands.centres_nm())
        for (const StackElement& element : stack_at(stack, nm))
            text += std::visit([](const auto& values) { return text_of(values); }, element) + "\n";
    for (const Eigen::MatrixXd& emission : slab_emissions(stack, bands))
        text += fmt::format("dyes {}\n", fmt::join(emission.reshaped(), " "));
    return sha256_hex(text);
}

} // namespace reradiant
