#include "host/scene/lights/clear_sky.h"

#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"

#include <cmath>
#include <numbers>

namespace reradiant {

namespace {

/// A row of the model's table.
struct Band {
    double nm, extraterrestrial, water, ozone, mixed;
};

/// Transmittances of what the air holds, each by itself.
struct Transmittances {
    double air, haze, haze_scattering, haze_absorption, water, ozone, mixed;
};

/// Aerosol of the countryside (the report's table of inputs).
constexpr double ANGSTROM_EXPONENT = 1.14, ALBEDO_AT_400 = 0.945, ALBEDO_SLOPE = 0.095,
                 ASYMMETRY = 0.65;

double cosine_of_zenith(const ClearSky& sky) {
    return std::sin(sky.sun_elevation_deg * std::numbers::pi / 180.0);
}

/// Kasten and Young 1989, "Revised optical air mass tables and approximation formula".
double air_mass(const ClearSky& sky) {
    const double elevation = sky.sun_elevation_deg;
    return 1.0 / (cosine_of_zenith(sky) + 0.50572 * std::pow(elevation + 6.07995, -1.6364));
}

/// `mass`: air on the light's way, relative to straight up. Ozone is taken along the sun's way.
Transmittances transmittances(const ClearSky& sky, const Band& band, double mass) {
    const double um = 1e-3 * band.nm;
    const double haze_depth =
        sky.aerosol_depth * std::pow(band.nm / 500.0, -ANGSTROM_EXPONENT); // [2-7]
    const double haze_albedo =
        ALBEDO_AT_400 * std::exp(-ALBEDO_SLOPE * std::pow(std::log(band.nm / 400.0), 2)); // [3-16]
    const double water = band.water * sky.water_cm * mass, mixed = band.mixed * mass;
    constexpr double height = 22.0 / 6370.0; // of ozone, over the earth's radius
    const double ozone_mass =
        (1.0 + height) / std::sqrt(std::pow(cosine_of_zenith(sky), 2) + 2.0 * height); // [2-10]
    Transmittances t{};
    t.air = std::exp(-mass / (std::pow(um, 4) * (115.6406 - 1.3366 / (um * um)))); // [2-4]
    t.haze = std::exp(-haze_depth * mass);                                         // [2-6]
    t.haze_scattering = std::exp(-haze_albedo * haze_depth * mass);                // [3-9]
    t.haze_absorption = std::exp(-(1.0 - haze_albedo) * haze_depth * mass);        // [3-10]
    t.water = std::exp(-0.2385 * water / std::pow(1.0 + 20.07 * water, 0.45));     // [2-8]
    t.ozone = std::exp(-band.ozone * sky.ozone_cm * ozone_mass);                   // [2-9]
    t.mixed = std::exp(-1.41 * mixed / std::pow(1.0 + 118.3 * mixed, 0.45));       // [2-11]
    return t;
}

/// Share of light that haze scatters forwards, from a cosine of the sun's zenith angle.
double forward_share(double cosine) {
    const double a = std::log(1.0 - ASYMMETRY);                          // [3-14]
    const double linear = a * (1.459 + a * (0.1595 + a * 0.4129));       // [3-12]
    const double quadratic = a * (0.0783 + a * (-0.3824 - a * 0.5874));  // [3-13]
    return 1.0 - 0.5 * std::exp((linear + quadratic * cosine) * cosine); // [3-11], [3-15]
}

/// Share of light from below that the sky sends back [3-8].
double sky_reflectance(const ClearSky& sky, const Band& band) {
    constexpr double mass = 1.8;
    const Transmittances t = transmittances(sky, band, mass);
    return t.mixed * t.water * t.haze_absorption *
           (0.5 * (1.0 - t.air) +
            (1.0 - forward_share(1.0 / mass)) * t.air * (1.0 - t.haze_scattering));
}

void append(const ClearSky& sky, const Band& band, ClearSkyLight& light) {
    const double cosine = cosine_of_zenith(sky);
    const Transmittances t = transmittances(sky, band, air_mass(sky));
    const double direct =
        band.extraterrestrial * t.air * t.haze * t.water * t.ozone * t.mixed; // [2-1]
    const double common =
        band.extraterrestrial * cosine * t.ozone * t.mixed * t.water * t.haze_absorption;
    const double by_air = common * (1.0 - std::pow(t.air, 0.95)) * 0.5; // [3-5]
    const double by_haze =
        common * std::pow(t.air, 1.5) * (1.0 - t.haze_scattering) * forward_share(cosine); // [3-6]
    const double bounce = sky_reflectance(sky, band) * sky.ground_albedo;
    const double by_ground =
        (direct * cosine + by_air + by_haze) * bounce / (1.0 - bounce); // [3-7]
    const double correction =
        band.nm <= 450.0 ? std::pow(1e-3 * band.nm + 0.55, 1.8) : 1.0; // [3-17]
    light.nm.push_back(band.nm);
    light.direct.push_back(direct);
    light.diffuse[0].push_back(by_air * correction);
    light.diffuse[1].push_back(by_haze * correction);
    light.diffuse[2].push_back(by_ground * correction);
}

} // namespace

ClearSkyLight clear_sky_light(const ClearSky& sky) {
    const NumberTable table = read_number_table(spectra_directory() / "sky" / "spectral2.csv", 5);
    const auto& columns = table.columns;
    ClearSkyLight light;
    for (std::size_t k = 0; k < columns[0].size(); ++k)
        append(sky, {columns[0][k], columns[1][k], columns[2][k], columns[3][k], columns[4][k]},
               light);
    return light;
}

double aerosol_depth_of_turbidity(double turbidity) {
    return (0.04608 * turbidity - 0.04586) * std::pow(0.5, -1.3);
}

} // namespace reradiant
