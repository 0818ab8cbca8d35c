#include "host/scene/toml/scene_parts.h"

#include "host/scene/lights/sky_light.h"

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// Azimuths count as those of an environment's image: from -z towards +x.
Vector3 read_sun(const TableReader& reader) {
    const double elevation =
        reader.number("sun_elevation_deg", {.low = 0.0, .high = 90.0, .low_is_allowed = false}) *
        std::numbers::pi / 180.0;
    const double azimuth =
        reader.number_or("sun_azimuth_deg", 0.0, NumberRange::within(-360.0, 360.0)) *
        std::numbers::pi / 180.0;
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            -std::cos(elevation) * std::cos(azimuth)};
}

ClearSky read_clear_sky(const TableReader& reader) {
    ClearSky sky;
    sky.sun_elevation_deg = reader.number("sun_elevation_deg");
    if (reader.has("turbidity") && reader.has("aerosol_depth"))
        reader.fail("aerosol_depth", "both turbidity and aerosol_depth are given", "keep one");
    sky.aerosol_depth =
        reader.number_or("aerosol_depth", sky.aerosol_depth, NumberRange::within(0.0, 5.0));
    reader.describe("turbidity", "number, 1 to 10");
    if (reader.has("turbidity"))
        sky.aerosol_depth =
            aerosol_depth_of_turbidity(reader.number("turbidity", NumberRange::within(1.0, 10.0)));
    sky.ground_albedo = reader.number_or("ground_albedo", sky.ground_albedo,
                                         {.low = 0.0, .high = 1.0, .high_is_allowed = false});
    sky.ozone_cm = reader.number_or("ozone_cm", sky.ozone_cm, NumberRange::within(0.0, 10.0));
    sky.water_cm = reader.number_or("water_cm", sky.water_cm, NumberRange::within(0.0, 10.0));
    return sky;
}

} // namespace

const std::vector<std::string>& sky_keys() {
    static const std::vector<std::string> keys{
        "sun_elevation_deg", "sun_azimuth_deg", "sun",      "turbidity", "aerosol_depth",
        "ground_albedo",     "ozone_cm",        "water_cm", "scale"};
    return keys;
}

std::vector<Light> read_sky(const TableReader& reader, LoadState& state) {
    const Vector3 to_sun = read_sun(reader);
    const ClearSkyLight light = clear_sky_light(read_clear_sky(reader));
    const double scale = reader.number_or("scale", 1.0, NumberRange::within(0.0, 1e18));
    Image image;
    EnvironmentLight sky = blue_sky_light(light, to_sun, image);
    sky.radiance = sky.radiance.scaled(scale);
    sky.image = static_cast<int>(state.images.size());
    state.images.push_back(std::move(image));
    state.image_is_linear.push_back(true);
    std::vector<Light> lights{std::move(sky)};
    if (reader.flag_or("sun", true)) {
        DirectionalLight sun = sun_light(light, to_sun);
        sun.irradiance = sun.irradiance.scaled(scale);
        lights.emplace_back(std::move(sun));
    }
    return lights;
}

} // namespace reradiant
