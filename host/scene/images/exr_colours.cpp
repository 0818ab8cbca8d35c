#include "host/scene/images/exr_colours.h"

#include "reradiant/colour.h"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include <fmt/core.h>

namespace reradiant {

namespace {

/// `Primaries` holds the XYZ of one unit of each of the three channels.
using Primaries = std::array<Xyz, 3>;

bool are_close(const Imath::V2f& a, const Imath::V2f& b) {
    constexpr float tolerance = 1e-5f; // of numbers that are given with four digits
    return std::fabs(a.x - b.x) <= tolerance && std::fabs(a.y - b.y) <= tolerance;
}

bool are_those_of_srgb(const Imf::Chromaticities& given) {
    const Imf::Chromaticities srgb; // the default is Rec. ITU-R BT.709
    return are_close(given.red, srgb.red) && are_close(given.green, srgb.green) &&
           are_close(given.blue, srgb.blue) && are_close(given.white, srgb.white);
}

[[noreturn]] void refuse_chromaticities(const SourcePosition& at) {
    throw_input_error(at, "its chromaticities are those of no colour space",
                      "give x and y of three primaries and a white that they can mix");
}

Primaries primaries_of(const Imf::Chromaticities& given, const SourcePosition& at) {
    Primaries primaries{};
    try {
        const Imath::M44f matrix = Imf::RGBtoXYZ(given, 1.0f); // rows
        for (int channel = 0; channel < 3; ++channel)
            for (int k = 0; k < 3; ++k)
                primaries[static_cast<std::size_t>(channel)][static_cast<std::size_t>(k)] =
                    static_cast<double>(matrix[channel][k]);
    } catch (const std::exception&) {
        refuse_chromaticities(at);
    }
    for (const Xyz& primary : primaries)
        for (const double value : primary)
            if (!(std::fabs(value) <= 1e6))
                refuse_chromaticities(at);
    return primaries;
}

/// Returns the primaries of the channels, or nothing where the channels are linear sRGB already.
std::optional<Primaries> primaries_of(const Imf::Header& header, ExrColours colours,
                                      const SourcePosition& at) {
    if (colours == ExrColours::Xyz)
        return Primaries{Xyz{1, 0, 0}, Xyz{0, 1, 0}, Xyz{0, 0, 1}};
    if (colours == ExrColours::Grey || !Imf::hasChromaticities(header))
        return std::nullopt;
    const Imf::Chromaticities& given = Imf::chromaticities(header);
    if (are_those_of_srgb(given))
        return std::nullopt;
    return primaries_of(given, at);
}

bool holds_halves(const Imf::Header& header) {
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (channel.channel().type == Imf::HALF)
            return true;
    return false;
}

} // namespace

void convert_to_linear_srgb(Image& image, const Imf::Header& header, ExrColours colours,
                            const SourcePosition& at) {
    const auto primaries = primaries_of(header, colours, at);
    if (!primaries)
        return;
    // Rounding may leave a pixel at an edge of the gamut this far outside, as a share of its
    // largest value: half floats have 11 bits.
    const double rounding = holds_halves(header) ? 0x1p-10 : 1e-5;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        Xyz xyz{};
        for (std::size_t channel = 0; channel < 3; ++channel)
            for (std::size_t k = 0; k < 3; ++k)
                xyz[k] += (*primaries)[channel][k] * static_cast<double>(image.rgb[i + channel]);
        const auto rgb = xyz_to_linear_srgb(xyz);
        const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
        if (*low < -rounding * std::fabs(*high)) {
            const auto width = static_cast<std::size_t>(image.width);
            throw_input_error(
                at,
                fmt::format("pixel ({}, {}) lies outside the gamut of linear sRGB: {:.4g}, {:.4g}, "
                            "{:.4g}",
                            i / 3 % width, i / 3 / width, rgb[0], rgb[1], rgb[2]),
                "map it into that gamut first");
        }
        for (std::size_t channel = 0; channel < 3; ++channel)
            image.rgb[i + channel] = static_cast<float>(std::max(rgb[channel], 0.0));
    }
}

} // namespace reradiant
