#pragma once

#include "host/spectral/colour/lamp.h"
#include "host/view/material_data.h"

#include <array>
#include <string>
#include <vector>

namespace reradiant {

/// A material as renderers of three colours can hold it: linear sRGB under one lamp, whose own
/// white is (1, 1, 1) by Bradford's adaptation to D65. Re-radiated light is in it, so that a colour
/// may exceed 1, and be negative beyond the gamut.
struct LampColours {
    using Rgb = std::array<double, 3>;
    struct Layer {
        double ior;   ///< at 550 nm
        double alpha; ///< width of the interface; 0: smooth
        Distribution distribution;
        Rgb transmittance; ///< of its slab, once along the normal
    };

    std::string material, lamp;
    std::vector<Layer> layers;
    Rgb substrate{}; ///< diffuse reflectance, or a metal's along the normal
    bool is_metal = false;
    double metal_alpha = 0.0;
    double sigma = 0.0;                ///< Oren-Nayar, radians
    std::vector<std::string> left_out; ///< sentences
};

/// Finds them, on the material's own bands. Input Error as viewed_models has it, and for a lamp
/// whose white the observer of 1931 does not see.
LampColours lamp_colours(const ViewedMaterial& viewed, const Lamp& lamp);

/// Refuses, by an input Error at its place, a material that files for other renderers cannot hold:
/// one with dyes in its layers, and what no page shows.
void require_exchangeable(const Material& material);

/// The head of a file in comments: what it is, of which lamp, and what it leaves out.
std::string exchange_head(const LampColours& colours, const std::string& what,
                          const std::string& comment);

/// Clipped to 0 to 1, as files of reflectances want it; a sentence is added to `notes` where that
/// changed something.
LampColours::Rgb clipped(const LampColours::Rgb& colour, const std::string& of,
                         std::vector<std::string>& notes);

/// A name made of letters, digits and underscores, as languages want it.
std::string identifier(const std::string& name);

} // namespace reradiant
