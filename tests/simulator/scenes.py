"""Tiny scenes that together use every feature of the kernels, each with options of `reradiant render`."""

HEAD = """
[film]
width = 4
height = 3
bands_nm = { from = 380, to = 700, step = 40 }
[camera]
origin = [0, 0, 3]
target = [0, 0, 0]
fov_deg = 45
%s
[integrator]
max_depth = 4
"""

LAMP = """
[[light]]
type = "rectangle"
center = [0, 2.5, 2]
edge_u = [1, 0, 0]
edge_v = [0, -0.4, 0.4]
radiance = { illuminant = "D65", scale = 5 }
"""
BULB = """
[[light]]
type = "sphere"
center = [2, 2, 1]
radius = 0.3
radiance = { line_nm = 405, width_nm = 10, scale = 50 }
"""
DELTAS = """
[[light]]
type = "point"
position = [0, 2, 2]
intensity = 3
[[light]]
type = "directional"
direction = [0, -1, -1]
irradiance = { blackbody_kelvin = 3000, scale = 1 }
"""
SHAPED = """
[[light]]
type = "disk"
center = [0, 2.5, 2]
target = [0, 0, 0]
radius = 0.4
radiance = 5
[[light]]
type = "mesh"
file = "lamp.obj"
radiance = 5
[[light]]
type = "spot"
position = [-1, 2, 2]
target = [0, 0, 0]
cone_deg = 40
intensity = 5
"""
CLEAR_DAY = """
[[light]]
type = "sky"
sun_elevation_deg = 40
"""
SKY = """
[[light]]
type = "environment"
radiance = 0.5
"""
IMAGE_SKY = """
[[light]]
type = "environment"
file = "image.png"
radiance = { illuminant = "D65" }
"""

BALL = """
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "m"
[[shape]]
type = "rectangle"
center = [0, -1, 0]
edge_u = [6, 0, 0]
edge_v = [0, 0, -6]
material = "m"
"""
PANE = """
[[shape]]
type = "rectangle"
center = [0, 0, 0]
edge_u = [3, 0, 0]
edge_v = [0, 3, 0]
material = "m"
[[shape]]
type = "sphere"
center = [0, 0, -2]
radius = 1
material = "grey"
[[material]]
name = "grey"
substrate = { type = "lambert", reflectance = 0.5 }
"""


def preset(name):
    return f'[[material]]\nname = "m"\npreset = "{name}"\n'


def material(text, model="auto"):
    return f'[[material]]\nname = "m"\nmodel = "{model}"\n{text}\n'


COATED = material(
    "layer = [{ ior = 1.5, roughness_deg = 8, absorption = { gaussian_nm = 450, sigma_nm = 40 }, thickness = 0.5 },\n"
    "         { ior = 1.7, roughness_deg = 15, distribution = \"beckmann\" }]\n"
    "substrate = { type = \"lambert\", reradiation = { file = \"synthetic-orange.csv\" } }")
DISPERSIVE = material(
    "layer = [{ ior = { nm = [380, 700], value = [1.55, 1.5] }, alpha = 0.1, distribution = \"blinn\" },\n"
    "         { ior = 1.3, alpha = 0.2 }]\nsubstrate = { type = \"oren-nayar\", sigma = 0.3, reflectance = 0.6 }",
    "weidlich-wilkie")
COATED_METAL = material(
    "layer = [{ ior = 1.5, roughness_deg = 5 }]\n"
    "substrate = { type = \"conductor\", metal = \"gold\", roughness_deg = 10 }", "walk")
FILMED = material(
    "layer = [{ ior = 1.5, film = { thickness_nm = 300, ior = 1.35 } }]\n"
    "substrate = { type = \"lambert\", reflectance = 0.4 }")
BARE_METAL = material("substrate = { type = \"conductor\", metal = \"gold\", roughness_deg = 10 }")
CLOUD = material(
    "layer = [{ ior = 1.4, thickness = 1, scattering_coefficient = 0.7, anisotropy = 0.5 }]\n"
    "substrate = { type = \"lambert\", reflectance = 0.3 }")
FLAKES = material(
    "layer = [{ ior = 1.5, alpha = 0.1, flakes = { coverage = 0.3, metal = \"silver\", alpha = 0.1 } }]\n"
    "substrate = { type = \"lambert\", reflectance = 0.3 }")
DYED_LAYER = ("layer = [{ ior = 1.5, thickness = 1, fluorophores = [{ absorption = { gaussian_nm = 440, sigma_nm = 30 },"
              " emission = { gaussian_nm = 580, sigma_nm = 30 }, quantum_yield = 0.9 }] }]\n")
DYED = material(DYED_LAYER + "substrate = { type = \"lambert\", reflectance = 0.8 }")
WALKED_DYE = material(DYED_LAYER + "substrate = { type = \"lambert\", reflectance = 0.8 }", "walk")
DYED_SHEET = material(DYED_LAYER + "substrate = { type = \"none\" }")
WALKED_SHEET = material(DYED_LAYER + "substrate = { type = \"none\" }\nback = { alpha = 0.1 }", "walk")
TINTED_PANE = material(
    "layer = [{ ior = 1.5, absorption = { gaussian_nm = 450, sigma_nm = 40 } }]\nsubstrate = { type = \"none\" }")
ROUGH_PANE = material("layer = [{ ior = 1.5, alpha = 0.2 }]\nsubstrate = { type = \"none\" }\nback = { alpha = 0.3 }")
DENSE = material("substrate = { type = \"lambert\", reradiation = { file = \"dense.csv\" } }")
TEXTURED = """
[[texture]]
name = "n"
type = "noise"
size = 0.3
levels = 3
tilt_deg = 10
[[texture]]
name = "i"
type = "image"
file = "image.png"
[[material]]
name = "m"
normal = { texture = "n" }
mix = { with = "b", weight = { texture = "n" } }
layer = [{ ior = 1.5, roughness_deg = { texture = "n", low = 3, high = 10 } }]
substrate = { type = "lambert", reflectance = { texture = "i" } }
[[material]]
name = "b"
substrate = { type = "conductor", metal = "gold", alpha = 0.1 }
"""
NESTED = """
[[texture]]
name = "c"
type = "checker"
size = 0.2
[[material]]
name = "m"
mix = { with = "b", weight = { texture = "c" } }
substrate = { type = "lambert", reflectance = 0.5 }
[[material]]
name = "b"
mix = { with = "c", weight = 0.5 }
substrate = { type = "lambert", reflectance = 0.2 }
[[material]]
name = "c"
substrate = { type = "conductor", metal = "gold", alpha = 0.1 }
"""
LENS = "lens_radius = 0.1\nfocus_distance = 2.5"

# Name, text, further options. `quick` ones are run in every suite.
SCENES = {
    "plain": (HEAD % "" + LAMP + BALL + material("substrate = { type = \"lambert\", reflectance = 0.5 }"), ""),
    "coated": (HEAD % "" + LAMP + BULB + BALL + COATED, ""),
    "dispersive": (HEAD % LENS + DELTAS + SKY + BALL + DISPERSIVE, ""),
    "metal under a coat": (HEAD % "" + LAMP + SKY + BALL + COATED_METAL, ""),
    "bare metal": (HEAD % "" + LAMP + BALL + BARE_METAL, ""),
    "cloudy": (HEAD % "" + LAMP + BALL + CLOUD, ""),
    "cloudy by walk": (HEAD % "" + LAMP + BALL + CLOUD.replace("auto", "walk"), ""),
    "flakes": (HEAD % "" + LAMP + DELTAS + BALL + FLAKES, ""),
    "dense": (HEAD % "" + LAMP + BALL + DENSE, ""),
    "dyed": (HEAD % "" + LAMP + BALL + DYED, ""),
    "dyed by walk": (HEAD % "" + LAMP + BALL + WALKED_DYE, ""),
    "dyed sheet": (HEAD % "" + LAMP + BULB.replace("1]", "-1]") + PANE + DYED_SHEET, ""),
    "walked sheet": (HEAD % "" + LAMP + PANE + WALKED_SHEET, ""),
    "tinted pane": (HEAD % "" + LAMP.replace("2]", "-2]", 1) + PANE + TINTED_PANE, ""),
    "rough pane": (HEAD % "" + LAMP.replace("2]", "-2]", 1) + PANE + ROUGH_PANE, ""),
    "textured": (HEAD % "" + LAMP + IMAGE_SKY + BALL + TEXTURED, ""),
    "varnished preset": (HEAD % "" + LAMP + BALL + preset("red-lacquer"), "--variance bands"),
    "wavelengths of their own": (HEAD % "" + LAMP + BULB + BALL + COATED, "--bands 383:703:8"),
    "film between": (HEAD % "" + LAMP + BALL + FILMED, ""),
    "shaped lamps": (HEAD % "" + SHAPED + BALL + COATED, ""),
    "clear day by walk": (HEAD % "" + CLEAR_DAY + BALL + COATED_METAL, ""),
    "nested mixtures": (HEAD % "" + LAMP + BALL + NESTED, ""),
    "light groups": (HEAD % "" + LAMP + BULB + BALL + COATED, "--light-groups"),
    "hero": (HEAD % "" + LAMP + BALL + COATED, "--wavelengths hero"),
    "all features": (HEAD % "" + LAMP + BALL + COATED, "--all-features"),
    "double": (HEAD % "" + LAMP + BALL + COATED, "--double"),
    "adaptive": (HEAD % "" + LAMP + BALL + COATED, "--adaptive --spp 8"),
}
QUICK = ("plain", "cloudy by walk")
