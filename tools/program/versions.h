#pragma once

#include <string>

namespace reradiant {

/// Version of the program and of the libraries it was built with, one a line.
std::string version_text();

} // namespace reradiant
