// The functions of toml++, compiled once: TOML_HEADER_ONLY is 0 everywhere (CMakeLists.txt).
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
