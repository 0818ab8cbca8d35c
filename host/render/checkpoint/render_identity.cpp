#include "host/render/checkpoint/render_identity.h"

#include "host/scene/model/sha256.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

std::string whole_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string bands_text(const std::optional<WavelengthGrid>& bands) {
    return bands ? fmt::format("{}:{}:{}", bands->from_nm, bands->to_nm(), bands->step_nm)
                 : "the scene's";
}

} // namespace

const std::string& build_digest() {
    static const std::string digest = [] {
        Sha256 sha;
        sha.update(whole_file("/proc/self/exe"));
        std::vector<fs::path> kernels;
        for (const auto& entry : fs::recursive_directory_iterator(data_directory() / "kernels"))
            if (entry.is_regular_file())
                kernels.push_back(entry.path());
        std::sort(kernels.begin(), kernels.end());
        for (const fs::path& kernel : kernels)
            sha.update(whole_file(kernel));
        return sha.hex();
    }();
    return digest;
}

SampleIdentity sampling_identity(const Scene& scene, const RenderOptions& options) {
    return {{"scene", scene.hash},
            {"seed", std::to_string(options.seed)},
            {"model", model_name(options.model)},
            {"bands", bands_text(options.bands)},
            {"wavelength count", std::to_string(options.wavelengths.comb_count)},
            {"hero wavelengths", std::to_string(options.wavelengths.hero_count)},
            {"comb phase", options.wavelengths.centred ? "centre" : "random"},
            {"variance per band", options.band_variance ? "on" : "off"},
            {"specialisation", options.all_features ? "off" : "on"},
            {"adaptive", options.adaptive ? "on" : "off"},
            {"precision", options.in_double ? "double" : "single"}};
}

SampleIdentity render_identity(const Scene& scene, const Device& device,
                               const RenderOptions& options) {
    const DeviceInfo& info = device.info();
    SampleIdentity identity = sampling_identity(scene, options);
    identity.push_back({"first sample", std::to_string(options.first_sample)});
    identity.push_back({"build", build_digest()});
    identity.push_back(
        {"device", fmt::format("{} ({}, {})", info.name, info.platform, info.driver)});
    return identity;
}

std::string identity_digest(const SampleIdentity& identity) {
    Sha256 sha;
    sha.update(identity_text(identity));
    return sha.hex();
}

} // namespace reradiant
