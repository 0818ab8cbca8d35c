#include "tools/program/versions.h"

#include "host/cluster/cluster.h"

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <OpenColorIO/OpenColorIO.h>
#include <OpenEXRConfig.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <png.h>

namespace reradiant {

std::string version_text() {
    return fmt::format("reradiant {}\n"
                       "OpenEXR {}, OpenColorIO {}, libpng {}\n"
                       "Eigen {}.{}.{}, CLI11 {}, nlohmann json {}.{}.{}\n"
                       "{}",
                       RERADIANT_VERSION, OPENEXR_VERSION_STRING, OCIO_NAMESPACE::GetVersion(),
                       PNG_LIBPNG_VER_STRING, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                       EIGEN_MINOR_VERSION, CLI11_VERSION, NLOHMANN_JSON_VERSION_MAJOR,
                       NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH, mpi_version());
}

} // namespace reradiant
