#include "host/view/packed_text.h"

#include "host/report/data_uri.h"
#include "reradiant/error.h"

#include <zlib.h>

namespace reradiant {

std::string packed_text(std::string_view bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw_runtime_error("what a page shows could not be packed");
    packed.resize(size);
    return base64(packed);
}

} // namespace reradiant
