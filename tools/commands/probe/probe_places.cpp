#include "tools/commands/probe/probe_places.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace reradiant {

namespace {

constexpr const char* at_form = "write X,Y or X,Y:R in pixels from the upper left, as in 10,20:3";
constexpr const char* region_form = "write X0,Y0,X1,Y1 in pixels, the upper left corner first";

/// Reads a number and what must follow it; false where the text is something else.
template <typename Number>
bool take(std::string_view& text, Number& value, std::string_view behind) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc())
        return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.starts_with(behind))
        return false;
    text.remove_prefix(behind.size());
    return true;
}

ImageRegion place_at(const std::string& text) {
    ImageRegion place{.name = "at " + text};
    std::string_view rest = text;
    const bool has_radius = text.find(':') != std::string::npos;
    bool is_right = take(rest, place.x0, ",") && take(rest, place.y0, has_radius ? ":" : "");
    if (is_right && has_radius)
        is_right = take(rest, place.radius, "");
    constexpr int farthest = 1 << 20; // beyond any picture, and far from what an int holds
    constexpr double widest = 65536.0;
    if (!is_right || !rest.empty() || std::abs(place.x0) > farthest ||
        std::abs(place.y0) > farthest ||
        (has_radius && !(place.radius > 0.0 && place.radius <= widest)))
        throw_input_error({}, fmt::format("--at: '{}' is no place", text), at_form);
    const int reach = static_cast<int>(std::floor(place.radius));
    place.x1 = place.x0 + reach;
    place.y1 = place.y0 + reach;
    place.x0 -= reach;
    place.y0 -= reach;
    return place;
}

ImageRegion region_of(const std::string& text) {
    ImageRegion region{.name = "region " + text};
    std::string_view rest = text;
    if (!take(rest, region.x0, ",") || !take(rest, region.y0, ",") || !take(rest, region.x1, ",") ||
        !take(rest, region.y1, "") || !rest.empty())
        throw_input_error({}, fmt::format("--region: '{}' is no region", text), region_form);
    if (region.x1 < region.x0 || region.y1 < region.y0)
        throw_input_error({},
                          fmt::format("--region: the second corner of '{}' lies above or left of "
                                      "the first",
                                      text),
                          region_form);
    return region;
}

} // namespace

std::vector<ImageRegion> probe_places(const std::vector<std::string>& at,
                                      const std::vector<std::string>& regions) {
    std::vector<ImageRegion> places;
    const auto add = [&places](ImageRegion place) {
        for (const ImageRegion& other : places)
            if (other.name == place.name)
                throw_input_error({}, fmt::format("--{} is given twice", place.name),
                                  "name every place once");
        places.push_back(std::move(place));
    };
    for (const std::string& text : at)
        add(place_at(text));
    for (const std::string& text : regions)
        add(region_of(text));
    if (places.empty())
        throw_input_error({}, "no place is given", "name some by --at X,Y or --region X0,Y0,X1,Y1");
    return places;
}

} // namespace reradiant
