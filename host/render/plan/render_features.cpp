#include "host/render/plan/render_features.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace reradiant {

namespace {

struct FeatureBit {
    const char* name;
    bool RenderFeatures::*value;
    const char* why_off;

    /// FEATURE_FLUORESCENCE for `fluorescence`.
    std::string define() const {
        std::string text = fmt::format("FEATURE_{}", name);
        std::transform(text.begin(), text.end(), text.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        return text;
    }
};

/// Deeper lobes of kernels that are specialised for nothing: more than most scenes have.
constexpr int generic_lobes = 4;

constexpr FeatureBit feature_bits[] = {
#define FEATURE_BIT(name, why_off) {#name, &RenderFeatures::name, why_off},
#include "kernels/core/feature_bits.h"
#undef FEATURE_BIT
};

} // namespace

RenderFeatures RenderFeatures::all() {
    RenderFeatures features;
    for (const FeatureBit& bit : feature_bits)
        features.*bit.value = true;
    features.lobes = generic_lobes;
    return features;
}

RenderFeatures RenderFeatures::only(const std::string& name) {
    RenderFeatures features;
    std::string names;
    for (const FeatureBit& bit : feature_bits) {
        if (name == bit.name) {
            features.*bit.value = true;
            features.lobes = features.deeper_lobes ? generic_lobes : 0;
            return features;
        }
        names += std::string(names.empty() ? "" : ", ") + bit.name;
    }
    throw std::invalid_argument(
        fmt::format("kernels have no feature '{}'; there are {}", name, names));
}

void RenderFeatures::add(const RenderFeatures& other) {
    for (const FeatureBit& bit : feature_bits)
        this->*bit.value |= other.*bit.value;
    lobes = std::max(lobes, other.lobes);
    walk_layers = std::max(walk_layers, other.walk_layers);
    dye_channels = std::max(dye_channels, other.dye_channels);
}

KernelDefines RenderFeatures::defines() const {
    KernelDefines defines;
    for (const FeatureBit& bit : feature_bits)
        defines.emplace_back(bit.define(), this->*bit.value ? 1 : 0);
    defines.emplace_back("CHUNKS", chunks);
    defines.emplace_back("FILM_CHUNKS", film_chunks);
    defines.emplace_back("LOBES", lobes);
    defines.emplace_back("HERO", hero);
    defines.emplace_back("WALK_LAYERS", walk_layers);
    defines.emplace_back("DYE_CHANNELS", dye_channels);
    if (in_double)
        defines.emplace_back("KERNELS_IN_DOUBLE", 1);
    return defines;
}

std::map<std::string, bool> RenderFeatures::listed() const {
    std::map<std::string, bool> list;
    for (const FeatureBit& bit : feature_bits)
        list[bit.name] = this->*bit.value;
    list["hero"] = hero > 0;
    list["double"] = in_double;
    return list;
}

std::vector<std::string> RenderFeatures::left_out() const {
    std::vector<std::string> lines;
    for (const FeatureBit& bit : feature_bits)
        if (!(this->*bit.value))
            lines.push_back(fmt::format("{}: {}", bit.name, bit.why_off));
    if (hero == 0)
        lines.push_back("hero: every path carries all wavelengths");
    if (!in_double)
        lines.push_back("double: not asked for");
    return lines;
}

} // namespace reradiant
