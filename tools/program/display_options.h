#pragma once

#include "host/film/display/develop.h"
#include "host/spectral/colour/lamp.h"
#include "tools/program/command_line.h"

#include <string>

namespace reradiant {

/// The options of every command that develops a spectral image, as they are typed.
struct DisplayTexts {
    std::filesystem::path ocio;
    std::string display, view, exposure = "0", white = "D65", gamut = "clip";
};

void add_display_options(Command& command, DisplayTexts& texts);

/// Input Error that names the option for what is none of its words. What may be wrong with a
/// configuration, check_develop says.
DevelopOptions parse_display_options(const DisplayTexts& texts);

/// Sets the white that a text means, as --white takes it: D65, a lamp's name or file, x,y or auto.
/// Input Error that names `option` for what is none of these.
void set_white(const char* option, const std::string& text, DevelopOptions& options);

/// A lamp by the name that `colour --illuminant` takes, or the file of one that exists. Input Error
/// that names the option; also for a lamp of which the eye sees almost nothing, which is no white.
Lamp white_lamp(const char* option, const std::string& text);
/// XYZ of such a lamp at a luminance.
Xyz white_of_lamp(const char* option, const std::string& text, double luminance);

} // namespace reradiant
