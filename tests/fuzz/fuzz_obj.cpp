#include "host/scene/meshes/mesh_io.h"
#include "tests/fuzz/check_mesh.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace reradiant;
    fuzz::read_or_refuse(
        [&] { fuzz::check_mesh(parse_mesh("input.obj", fuzz::text_of(bytes, size))); });
    return 0;
}
