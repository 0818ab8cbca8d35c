#include "host/report/json_file.h"

#include "host/base/atomic_file.h"

namespace reradiant {

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value) {
    if (file.empty())
        return;
    // Text from the command line or a file need not be UTF-8; a result is not lost for that.
    constexpr auto on_bad_utf8 = nlohmann::ordered_json::error_handler_t::replace;
    write_text_atomically(file, value.dump(2, ' ', false, on_bad_utf8) + "\n");
}

} // namespace reradiant
