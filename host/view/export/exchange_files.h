#pragma once

#include "host/view/export/lamp_colours.h"

namespace reradiant {

/// GLSL ES 3.00: the functions of the model that the page begins with (material.glsl), with tables
/// and bands as constants, and `vec3 rr_eval(vec3 wi, vec3 wo)`: linear sRGB of the radiance
/// towards wo, cosine of wi included, over the lamp's irradiance at normal incidence (Y = 1).
/// `rr_mirror_colour(float cosine)` is the mirror's weight. Throws as material_data does.
std::string glsl_file(const ViewedMaterial& viewed, const Lamp& lamp);

/// Open Shading Language: the nested model of Weidlich and Wilkie (2007) with closures.
std::string osl_file(const LampColours& colours);

/// MaterialX 1.39: the nearest OpenPBR surface.
std::string materialx_file(const LampColours& colours);

/// A BSDF for scenes of Mitsuba 3 in XML: the nearest roughplastic, plastic or principled.
std::string mitsuba_file(const LampColours& colours);

} // namespace reradiant
