#pragma once

#include "host/study/converge/converge.h"

namespace reradiant {

/// error-over-time.svg: relMSE over seconds, logarithmic both ways, a curve a method.
std::string curves_svg(const ConvergeResult& result);

/// Writes error-over-time.svg, a picture and an error image of every method beneath images/, and
/// index.html, which holds all of them and needs no other file.
void write_converge_page(const std::filesystem::path& folder, const ConvergeResult& result,
                         const Scene& scene, const Device& device);

} // namespace reradiant
