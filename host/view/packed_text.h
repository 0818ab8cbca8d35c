#pragma once

#include <string>
#include <string_view>

namespace reradiant {

/// Bytes deflated (RFC 1950), in base64: what pages unpack by themselves
/// (host/view/page/start.js).
std::string packed_text(std::string_view bytes);

} // namespace reradiant
