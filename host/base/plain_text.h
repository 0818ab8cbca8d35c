#pragma once

#include <string>
#include <string_view>

namespace reradiant {

/// A text as every reader wants it: without the byte order mark of UTF-8, lines that end with LF
/// (not CR LF or CR alone), and without the control-Z that DOS put behind the end.
std::string plain_text(std::string_view bytes);

} // namespace reradiant
