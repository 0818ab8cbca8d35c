#include "host/scene/mitsuba/mitsuba_scene.h"

#include "host/base/logging.h"

#include <Eigen/LU>
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace reradiant {

namespace {

using Vector = Eigen::Vector3d;

/// Mitsuba's paths are unlimited by default; this many interactions hold all light but 0.9^64 of
/// that of a scene whose every surface reflects 90 %.
constexpr int unlimited_depth = 64;

struct FilmSize {
    int width = 768, height = 576; // Mitsuba's own
};

FilmSize read_film(const MitsubaObject& sensor, MitsubaScene& scene) {
    const auto films = sensor.nested("film");
    if (films.size() > 1)
        sensor.fail(fmt::format("the {} has {} films", sensor.title(), films.size()), "give one");
    FilmSize size;
    if (!films.empty()) {
        const MitsubaObject film(scene.document(), films.front());
        if (film.type() != "hdrfilm" && film.type() != "specfilm")
            film.refuse_type({"hdrfilm", "specfilm"});
        size.width = film.integer_or("width", size.width);
        size.height = film.integer_or("height", size.height);
        for (const char* name : {"file_format", "pixel_format", "component_format", "banner"})
            film.ignore(name, "images are spectral EXR files in single precision");
        film.ignore("sample_border", "pixels are means over their area");
        if (!film.nested("rfilter").empty())
            logging::warn("{}: the filter of the {} is left out: pixels are means over their area",
                          scene.document().position(films.front()).text(), film.title());
        for (const pugi::xml_node& band : film.element().children("spectrum"))
            film.ignore(band.attribute("name").value(), "choose bands with --bands");
        film.finish();
    }
    scene.set("film", toml::table{{"width", size.width}, {"height", size.height}},
              films.empty() ? sensor.element() : films.front());
    return size;
}

constexpr double half_degree = std::numbers::pi / 360.0;

/// The vertical field of view of a focal length: of a frame of 36 mm x 24 mm along the diagonal.
double fov_of_focal_length(const MitsubaObject& sensor, const FilmSize& size) {
    const std::string text = sensor.text_or("focal_length", "50mm");
    double length_mm = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, length_mm);
    const std::string_view rest(stop, end);
    if (failure != std::errc{} || !(length_mm > 0.0) || (!rest.empty() && rest != "mm"))
        sensor.document().fail(sensor.find("focal_length"),
                               fmt::format("\"{}\" is not a focal length", text),
                               "give millimetres above 0, for instance \"50mm\"");
    const double half_diagonal = 0.5 * std::hypot(36.0, 24.0) / length_mm;
    return std::atan(half_diagonal * size.height / std::hypot(size.width, size.height)) /
           half_degree;
}

/// The vertical field of view from the one along `fov_axis`.
double vertical_fov(const MitsubaObject& sensor, const FilmSize& size) {
    if (!sensor.has("fov"))
        return fov_of_focal_length(sensor, size);
    const double width = size.width, height = size.height;
    const double fov = sensor.number_or("fov", 0.0);
    if (!(fov > 0.0 && fov < 180.0))
        sensor.fail(fmt::format("the {} has a fov of {} degrees", sensor.title(), fov),
                    "give <float name=\"fov\"> above 0 and below 180");
    const std::string axis = sensor.text_or("fov_axis", "x");
    double length = 0.0; // of the film along the axis
    if (axis == "x")
        length = width;
    else if (axis == "y")
        length = height;
    else if (axis == "diagonal")
        length = std::hypot(width, height);
    else if (axis == "smaller")
        length = std::min(width, height);
    else if (axis == "larger")
        length = std::max(width, height);
    else
        sensor.document().fail(sensor.find("fov_axis"),
                               fmt::format("the fov_axis \"{}\" is not known", axis),
                               "use x, y, diagonal, smaller or larger");
    return std::atan(std::tan(fov * half_degree) * height / length) / half_degree;
}

/// A camera looks along its +z with +y up and +x to the left.
toml::table camera_at(const MitsubaObject& sensor) {
    const Eigen::Matrix4d matrix = sensor.transform_or_identity("to_world");
    const Vector forward = matrix.block<3, 1>(0, 2), up = matrix.block<3, 1>(0, 1),
                 origin = matrix.block<3, 1>(0, 3);
    if (!(matrix.topLeftCorner<3, 3>().determinant() > 0.0))
        sensor.document().fail(sensor.find("to_world"), "the camera's picture is mirrored",
                               "leave out the scale by -1");
    return toml::table{{"origin", toml_vector(origin)},
                       {"target", toml_vector(origin + forward.normalized())},
                       {"up", toml_vector(up.normalized())}};
}

void read_sampler(const MitsubaObject& sensor, MitsubaScene& scene) {
    for (const pugi::xml_node& element : sensor.nested("sampler")) {
        const MitsubaObject sampler(scene.document(), element);
        sampler.ignore("sample_count", "say --spp when rendering");
        sampler.ignore("seed", "say --seed when rendering");
        sampler.finish();
    }
}

} // namespace

void add_mitsuba_sensor(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject sensor(scene.document(), element);
    if (scene.table().contains("camera"))
        sensor.fail("the scene has a second sensor", "leave one");
    if (sensor.type() != "perspective" && sensor.type() != "thinlens")
        sensor.refuse_type({"perspective", "thinlens"});
    const FilmSize size = read_film(sensor, scene);
    toml::table camera = camera_at(sensor);
    camera.insert("fov_deg", vertical_fov(sensor, size));
    if (sensor.type() == "thinlens") {
        camera.insert("lens_radius", sensor.number_or("aperture_radius", 0.0));
        camera.insert("focus_distance", sensor.number_or("focus_distance", 1.0));
    } else {
        sensor.ignore("focus_distance", "a pinhole has none");
    }
    for (const char* name : {"principal_point_offset_x", "principal_point_offset_y"})
        if (sensor.number_or(name, 0.0) != 0.0)
            sensor.document().fail(sensor.find(name), fmt::format("{} is not supported", name),
                                   "give 0");
    for (const char* name : {"near_clip", "far_clip"})
        sensor.ignore(name, "nothing is clipped");
    read_sampler(sensor, scene);
    sensor.finish();
    scene.set("camera", std::move(camera), element);
}

void add_mitsuba_integrator(const pugi::xml_node& element, MitsubaScene& scene) {
    const MitsubaObject integrator(scene.document(), element);
    if (integrator.type() == "moment" || integrator.type() == "aov") { // adds to another's image
        integrator.ignore("aovs", "an image holds radiance alone");
        for (const pugi::xml_node& inside : integrator.nested("integrator"))
            add_mitsuba_integrator(inside, scene);
        integrator.finish();
        return;
    }
    if (integrator.type() != "path" && integrator.type() != "direct")
        integrator.refuse_type({"path", "direct", "moment", "aov"});
    toml::table settings;
    if (integrator.type() == "direct") {
        settings.insert("max_depth", 1);
        for (const char* name : {"emitter_samples", "bsdf_samples", "shading_samples"})
            integrator.ignore(name, "say --spp when rendering");
    } else {
        // A depth of n is n - 1 surface interactions; 1 shows lights alone.
        const int depth = integrator.integer_or("max_depth", -1);
        if (depth == 0 || depth == 1)
            integrator.document().fail(integrator.find("max_depth"),
                                       "the path depth leaves no reflection", "give 2 or more");
        settings.insert("max_depth", depth < 0 ? unlimited_depth : depth - 1);
        settings.insert("min_depth", std::max(integrator.integer_or("rr_depth", 5) - 1, 0));
    }
    if (integrator.flag_or("hide_emitters", false))
        integrator.document().fail(integrator.find("hide_emitters"),
                                   "hide_emitters is not supported", "leave it out");
    integrator.finish();
    scene.set("integrator", std::move(settings), element);
}

} // namespace reradiant
