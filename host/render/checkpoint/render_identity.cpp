#include "host/render/checkpoint/render_identity.h"

#include "host/scene/model/sha256.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>
#include <vector>

#include <link.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

std::string whole_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// Finds the note that holds the linker's digest among those of a loaded object.
std::string digest_in(const char* notes, std::size_t size) {
    const auto padded = [](std::size_t n) { return (n + 3) / 4 * 4; };
    for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
        ElfW(Nhdr) header;
        std::memcpy(&header, notes + at, sizeof header);
        const std::size_t name = at + sizeof header, digest = name + padded(header.n_namesz);
        if (header.n_type == NT_GNU_BUILD_ID && header.n_namesz == sizeof ELF_NOTE_GNU &&
            std::memcmp(notes + name, ELF_NOTE_GNU, sizeof ELF_NOTE_GNU) == 0)
            return {notes + digest, header.n_descsz};
        at = digest + padded(header.n_descsz);
    }
    return {};
}

/// What dl_iterate_phdr looks for: the object that this code lies in, and its digest.
struct LinkedObject {
    ElfW(Addr) here;
    std::string digest;
};

int read_digest(dl_phdr_info* object, std::size_t, void* search) {
    LinkedObject& wanted = *static_cast<LinkedObject*>(search);
    const std::span segments(object->dlpi_phdr, object->dlpi_phnum);
    const bool holds = std::ranges::any_of(segments, [&](const ElfW(Phdr) & segment) {
        return segment.p_type == PT_LOAD && wanted.here - object->dlpi_addr >= segment.p_vaddr &&
               wanted.here - object->dlpi_addr - segment.p_vaddr < segment.p_memsz;
    });
    if (!holds)
        return 0;
    for (const ElfW(Phdr) & segment : segments)
        if (segment.p_type == PT_NOTE && wanted.digest.empty())
            wanted.digest =
                digest_in(reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr),
                          segment.p_memsz);
    return 1;
}

/// The linker's digest of the program or library that this code lies in; reading the whole file
/// would take a tenth of a second. The file itself where it was linked without.
std::string linked_digest() {
    LinkedObject own{reinterpret_cast<ElfW(Addr)>(&linked_digest), {}};
    dl_iterate_phdr(read_digest, &own);
    return own.digest.empty() ? whole_file("/proc/self/exe") : own.digest;
}

std::string bands_text(const std::optional<WavelengthGrid>& bands) {
    return bands ? fmt::format("{}:{}:{}", bands->from_nm, bands->to_nm(), bands->step_nm)
                 : "the scene's";
}

} // namespace

const std::string& build_digest() {
    static const std::string digest = [] {
        Sha256 sha;
        sha.update(linked_digest());
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
            {"keeping of light groups", options.light_groups ? "on" : "off"},
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
