#include "tools/commands/probe/probed_places.h"

#include "host/report/svg.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

using Json = nlohmann::ordered_json;

void compare(ProbedPlace& place, const ProbedPlace& first) {
    const RegionValues &here = place.values, &there = first.values;
    for (std::size_t band = 0; band < here.radiance.size(); ++band) {
        const ValueRatio ratio = ratio_of(here.radiance[band], here.radiance_stderr[band],
                                          there.radiance[band], there.radiance_stderr[band]);
        place.ratio.push_back(ratio.value);
        place.ratio_stderr.push_back(ratio.standard_error);
    }
    const ValueRatio luminance =
        ratio_of(here.xyz[1], here.luminance_stderr, there.xyz[1], there.luminance_stderr);
    place.luminance_ratio = luminance.value;
    place.luminance_ratio_stderr = luminance.standard_error;
    place.ciede2000 = ciede2000(first.lab, place.lab);
}

const char* source_text(ErrorSource source) {
    switch (source) {
    case ErrorSource::Variance:
        return "variance";
    case ErrorSource::Spread:
        return "spread";
    case ErrorSource::Unknown:
        break;
    }
    return "unknown";
}

Json place_json(const ProbedPlace& place) {
    const RegionValues& values = place.values;
    const double sum = values.xyz[0] + values.xyz[1] + values.xyz[2];
    return {{"place", place.region.name},
            {"pixels", values.pixels},
            {"radiance", values.radiance},
            {"radiance_stderr", values.radiance_stderr},
            {"radiance_stderr_from", source_text(values.radiance_error)},
            {"XYZ", values.xyz},
            {"xy", {values.xyz[0] / sum, values.xyz[1] / sum}},
            {"luminance", values.xyz[1]},
            {"luminance_stderr", values.luminance_stderr},
            {"luminance_stderr_from", source_text(values.luminance_error)},
            {"Lab", place.lab}};
}

Json pair_json(const ProbedPlace& place, const ProbedPlace& first) {
    return {{"place", place.region.name},
            {"over", first.region.name},
            {"ratio", place.ratio},
            {"ratio_stderr", place.ratio_stderr},
            {"luminance_ratio", place.luminance_ratio},
            {"luminance_ratio_stderr", place.luminance_ratio_stderr},
            {"ciede2000", place.ciede2000}};
}

/// A cell of a table: nothing where a number is not known.
std::string cell(double value) {
    return std::isfinite(value) ? fmt::format(",{:.9g}", value) : ",";
}

/// A name without the comma that parts cells.
std::string heading(const ImageRegion& region) {
    std::string name = region.name;
    for (char& letter : name)
        if (letter == ',')
            letter = ' ';
    return name;
}

std::string with_error(double value, double standard_error) {
    return std::isfinite(standard_error) ? fmt::format("{:.5g} +- {:.2g}", value, standard_error)
                                         : fmt::format("{:.5g}", value);
}

} // namespace

ProbedImage probe(const SpectralImage& image, const std::vector<ImageRegion>& regions,
                  const Xyz& white) {
    ProbedImage probed;
    probed.white = white;
    probed.bands = image.bands;
    for (const ImageRegion& region : regions) {
        ProbedPlace place{.region = region, .values = region_values(image, region)};
        place.lab = xyz_to_lab(place.values.xyz, white);
        probed.places.push_back(std::move(place));
    }
    for (std::size_t k = 1; k < probed.places.size(); ++k)
        compare(probed.places[k], probed.places.front());
    return probed;
}

Json probe_json(const ProbedImage& probed) {
    Json json = {{"image", probed.image},     {"lamp", probed.lamp},
                 {"white_XYZ", probed.white}, {"nm", probed.bands.centres_nm()},
                 {"places", Json::array()},   {"pairs", Json::array()}};
    for (const ProbedPlace& place : probed.places) {
        json["places"].push_back(place_json(place));
        if (!place.ratio.empty())
            json["pairs"].push_back(pair_json(place, probed.places.front()));
    }
    return json;
}

std::string probe_csv(const ProbedImage& probed) {
    std::string text = "# spectral radiance of " + probed.image +
                       ", W m^-2 sr^-1 nm^-1, with standard errors; ratios are to the first place\n"
                       "nm";
    for (const ProbedPlace& place : probed.places)
        text += fmt::format(",{0},{0} stderr", heading(place.region));
    for (std::size_t k = 1; k < probed.places.size(); ++k)
        text += fmt::format(",{0} ratio,{0} ratio stderr", heading(probed.places[k].region));
    for (std::size_t band = 0; band < static_cast<std::size_t>(probed.bands.count); ++band) {
        text += fmt::format("\n{:.9g}", probed.bands.centre_nm(static_cast<int>(band)));
        for (const ProbedPlace& place : probed.places)
            text += cell(place.values.radiance[band]) + cell(place.values.radiance_stderr[band]);
        for (std::size_t k = 1; k < probed.places.size(); ++k)
            text += cell(probed.places[k].ratio[band]) + cell(probed.places[k].ratio_stderr[band]);
    }
    return text + "\n";
}

std::string probe_plot(const ProbedImage& probed) {
    constexpr double quantile = 1.96; // 95 % of a normal distribution
    std::vector<svg::Series> series;
    for (const ProbedPlace& place : probed.places) {
        svg::Series one{place.region.name, probed.bands.centres_nm(), place.values.radiance};
        for (std::size_t band = 0; band < one.y.size(); ++band) {
            const double reach = quantile * place.values.radiance_stderr[band];
            one.low.push_back(one.y[band] - reach);
            one.high.push_back(one.y[band] + reach);
        }
        series.push_back(std::move(one));
    }
    return svg::line_plot({.title = probed.image,
                           .x_label = "wavelength / nm",
                           .y_label = "spectral radiance / W m⁻² sr⁻¹ nm⁻¹"},
                          series);
}

std::string probe_text(const ProbedImage& probed) {
    std::string text;
    const ProbedPlace& first = probed.places.front();
    for (const ProbedPlace& place : probed.places) {
        const RegionValues& values = place.values;
        text += fmt::format("{}: {} pixel{}, luminance {} ({}), XYZ {:.5g} {:.5g} {:.5g}, Lab "
                            "{:.2f} {:.2f} {:.2f}\n",
                            place.region.name, values.pixels, values.pixels == 1 ? "" : "s",
                            with_error(values.xyz[1], values.luminance_stderr),
                            source_text(values.luminance_error), values.xyz[0], values.xyz[1],
                            values.xyz[2], place.lab[0], place.lab[1], place.lab[2]);
        if (!place.ratio.empty())
            text += fmt::format("  over {}: luminance {}, CIEDE2000 {:.2f}\n", first.region.name,
                                with_error(place.luminance_ratio, place.luminance_ratio_stderr),
                                place.ciede2000);
    }
    return text;
}

} // namespace reradiant
