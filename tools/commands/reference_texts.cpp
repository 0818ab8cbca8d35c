#include "tools/commands/reference.h"

#include <map>

namespace reradiant {

namespace {

/// By "part of the table's name / key" where a key means different things, else by the key alone.
const std::map<std::string, std::string> texts{
    {"width", "pixels"},
    {"height", "pixels"},
    {"heightfield/height", "of white above black, along the normal"},
    {"bands_nm", "centres of the film's bands, both ends included; without it 10 nm steps over "
                 "what the scene needs"},
    {"from", "first centre, nm"},
    {"to", "last centre, nm"},
    {"step", "nm"},
    {"origin", "where the camera stands"},
    {"target", "what it looks at"},
    {"up", "what is up in the picture"},
    {"fov_deg", "vertical field of view, degrees"},
    {"lens_radius", "0 is a pinhole"},
    {"focus_distance", "what is sharp; by default the target's distance"},
    {"max_depth", "surface interactions along a path; 1 is direct light only"},
    {"min_depth", "interactions before Russian roulette"},
    {"type", "which keys the table has"},
    {"center", "middle"},
    {"edge_u", "full edge"},
    {"edge_v", "full edge; a rectangle faces, and emits towards, cross(edge_u, edge_v)"},
    {"radius", "length"},
    {"[[light]]/target", "the point that it faces, instead of edges, normal or direction"},
    {"group", "lights of one name are a layer of `render --light-groups`"},
    {"size", "lengths of edge_u, which is level, and edge_v, with target"},
    {"cone_deg", "half angle of the cone that it lights"},
    {"falloff_deg", "how far within the cone its light begins to fall, smoothly"},
    {"angle_deg", "full angle of the cone that it comes from; 0: from one direction"},
    {"sun_elevation_deg", "of the sun above the horizon"},
    {"sun_azimuth_deg", "of the sun, from -z towards +x"},
    {"sun", "without it the sky alone shines"},
    {"turbidity", "haze: 2 is clear, 6 hazy; instead of aerosol_depth"},
    {"aerosol_depth", "optical depth of the haze straight up, at 500 nm"},
    {"ground_albedo", "of the land around, which lights the sky from below"},
    {"ozone_cm", "column of ozone, atm-cm"},
    {"water_cm", "column of water vapour, precipitable cm"},
    {"(sky)/scale", "multiplies sun and sky"},
    {"(cylinder)/from", "middle of one end"},
    {"(cylinder)/to", "middle of the other end; the ends are open"},
    {"(instance)/file", "PLY or OBJ, read and kept once for all its instances"},
    {"(mesh)/scale", "a factor, or one for each axis, instead of transform: first of three steps"},
    {"(instance)/scale",
     "a factor, or one for each axis, instead of transform: first of three steps"},
    {"rotate_deg", "then turns about x, then y, then z"},
    {"translate", "then moves"},
    {"opacity", "share of rays that the surface stops; others go on as if it were not there"},
    {"strength", "share of the fluorescence that is left, 0 to 1; the diagonal stays"},
    {"product", "spectra that are multiplied: a lamp, and the filters before it"},
    {"by product/scale", "multiplies the product"},
    {"sum", "spectra that are added"},
    {"by sum/scale", "multiplies the sum"},
    {"SPECTRUM/min", "values below it are raised to it, after scale"},
    {"SPECTRUM/max", "values above it are lowered to it, after scale"},
    {"normal", "direction that it faces"},
    {"[[material]]/normal", "a texture that tilts the surface"},
    {"position", "where it stands"},
    {"direction", "the way the light travels"},
    {"radiance", "W m^-2 sr^-1 per nm"},
    {"(environment)/radiance",
     "W m^-2 sr^-1 per nm; of an image, what white stands for (D65 by default)"},
    {"intensity", "W sr^-1 per nm"},
    {"irradiance", "W m^-2 per nm on a plane that faces the light"},
    {"rotation_deg", "turns the image right-handed about +y"},
    {"(environment)/file", "image of latitude and longitude: top row +y, middle column -z"},
    {"(mesh)/file", "PLY or OBJ"},
    {"(heightfield)/file", "image, its grey values are heights"},
    {"transform", "upper three rows of the matrix that moves the mesh, row after row"},
    {"flip_v", "takes 1 - v of the file for v; row 0 of an image is at v = 1"},
    {"face_normals", "leaves the file's normals out"},
    {"smooth_normals", "computes normals at the vertices where the file has none"},
    {"material", "name of a [[material]]"},
    {"name", "what others refer to it by"},
    {"preset", "a material of spectra/materials, or a material file (x.toml); other keys are laid "
               "over it"},
    {"model", "how light between the layers is followed"},
    {"layer", "interfaces and slabs, air side first"},
    {"substrate", "what lies at the bottom; none: the layers are a sheet in air"},
    {"back", "the lower face of a sheet; without it the face is smooth"},
    {"mix", "another material that shows in part"},
    {"with", "name of the other material"},
    {"weight", "its share, or a texture that is the share"},
    {"texture", "name of a [[texture]]"},
    {"low", "value where the texture is 0"},
    {"high", "value where the texture is 1"},
    {"ior", "index of refraction of what lies beneath the interface"},
    {"(conductor)/ior", "n of n + i kappa"},
    {"flakes/ior", "n of n + i kappa"},
    {"film/ior", "index of refraction of the film"},
    {"kappa", "kappa of n + i kappa"},
    {"metal", "a table of spectra/metals instead of ior and kappa"},
    {"roughness_deg", "angle where the distribution of normals falls to half; 0 is smooth"},
    {"alpha", "width of the distribution, instead of roughness_deg"},
    {"distribution", "of the facets' normals; ggx by default"},
    {"scattering", "light between facets: followed (multiple, the default) or left out"},
    {"thickness", "of the slab, in the unit that absorption is per"},
    {"(lambert)/thickness", "of the layer of pigments; without it the layer is opaque"},
    {"(oren-nayar)/thickness", "of the layer of pigments; without it the layer is opaque"},
    {"absorption", "coefficient per unit of thickness (Beer and Lambert)"},
    {"pigment/absorption", "K of Kubelka and Munk, at concentration 1"},
    {"dye/absorption", "K of Kubelka and Munk, at concentration 1"},
    {"pigment/scattering", "S of Kubelka and Munk, at concentration 1"},
    {"scattering_coefficient", "per unit of thickness"},
    {"anisotropy", "mean cosine of the scattering (Henyey and Greenstein)"},
    {"film", "a thin film on the surface: coherent interference"},
    {"thickness_nm", "of the film"},
    {"flakes", "metal flakes at the lower end of the slab"},
    {"coverage", "share of the area that flakes cover"},
    {"sigma", "roughness of Oren and Nayar, radians"},
    {"reflectance", "share of light that is reflected; without any colour 0.5"},
    {"reradiation", "what fluoresces: a matrix or fluorophores"},
    {"reradiation/file", "re-radiation matrix: CSV, BFC or bispectral EXR"},
    {"fluorophores", "dyes whose matrices are added"},
    {"[[material.layer]]/fluorophores", "dyes in the slab, which absorb light and send it out"},
    {"layer.fluorophores]]/absorption",
     "coefficient per unit of thickness at concentration 1 (natural logarithm)"},
    {"layer.fluorophores]]/concentration", "multiplies the absorption"},
    {"shares", "what part of the power absorbed in a band is sent out in each, instead of emission "
               "and quantum_yield"},
    {"shares/file", "re-radiation matrix: CSV, BFC or bispectral EXR; the diagonal is what is sent "
                    "out within the band that was absorbed, columns sum to 1 at most"},
    {"excitation", "share of the photons that is absorbed"},
    {"emission", "relative radiant power per nm"},
    {"quantum_yield", "photons emitted over photons absorbed"},
    {"pigments", "what scatters and absorbs, by Kubelka and Munk"},
    {"dyes", "what fluoresces among the pigments"},
    {"backing", "reflectance of what lies under a layer of pigments"},
    {"concentration", "multiplies absorption and scattering"},
    {"fluorophore/concentration", "c times what there is: an absorbed share x becomes 1 - (1 - "
                                  "x)^c, and the reflectance follows"},
    {"space", "world or uv: where the texture is looked up; image uv, else world"},
    {"size", "of a lattice cell, flake, square or tile"},
    {"levels", "steps that what it controls is tabulated in"},
    {"seed", "another number, another pattern"},
    {"tilt_deg", "standard deviation of the tilt of normals"},
    {"octaves", "of the noise"},
    {"sharpness", "contrast of the noise"},
    {"share", "of flakes that are 1, all others are 0; without it values are uniform"},
    {"(image)/file", "PNG or EXR"},
    {"normal_map", "the image holds normals of tangent space"},
    {"linear", "a PNG holds linear values instead of sRGB"},
    {"nm", "wavelengths"},
    {"value", "values there; linear between, constant outside"},
    {"by nm/scale", "multiplies the values"},
    {"file", "SPD or CSV, relative to this file or of spectra/"},
    {"by file/scale", "multiplies the file's values, a lamp's too: they get no luminance by it"},
    {"rgb", "linear sRGB, made into a smooth reflectance"},
    {"by rgb/scale", "multiplies the spectrum"},
    {"illuminant", "a CIE illuminant by name"},
    {"illuminant/scale", "luminance Y, where unit radiance at every wavelength has 1"},
    {"blackbody_kelvin", "temperature"},
    {"blackbody_kelvin/scale", "luminance Y"},
    {"line_nm", "a narrow line, a box"},
    {"line_nm/scale", "its integral over wavelength"},
    {"width_nm", "of the box"},
    {"gaussian_nm", "where its peak is"},
    {"sigma_nm", "standard deviation"},
    {"gaussian_nm/scale", "its peak"},
};

} // namespace

std::string reference_text(const std::string& table, const std::string& key) {
    std::string found;
    std::size_t found_at = 0; // the innermost part of the name decides
    for (const auto& [name, text] : texts) {
        const std::size_t slash = name.rfind('/');
        if (slash == std::string::npos || name.substr(slash + 1) != key)
            continue;
        const std::size_t at = table.rfind(name.substr(0, slash));
        if (at != std::string::npos && (found.empty() || at > found_at)) {
            found = text;
            found_at = at;
        }
    }
    if (!found.empty())
        return found;
    const auto plain = texts.find(key);
    return plain == texts.end() ? std::string() : plain->second;
}

} // namespace reradiant
