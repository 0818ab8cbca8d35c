#include "host/device/program_cache.h"

#include "host/base/atomic_file.h"
#include "host/base/regular_file.h"
#include "host/device/source.h"
#include "reradiant/paths.h"

#include <iterator>
#include <string_view>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view magic = "reradiant-program-1\n";
constexpr std::size_t digest_letters = 16;
constexpr std::uintmax_t most_bytes = std::uintmax_t{256} << 20;

} // namespace

fs::path cached_program_file(const std::string& key) {
    return cache_directory() / "programs" / (key + ".bin");
}

std::string read_cached_program(const fs::path& file) {
    std::ifstream stream = open_regular_file(file);
    std::error_code failure;
    if (!stream || fs::file_size(file, failure) > most_bytes || failure)
        return {};
    const std::string content((std::istreambuf_iterator<char>(stream)), {});
    const std::size_t head = magic.size() + digest_letters + 1;
    if (content.size() <= head || content.compare(0, magic.size(), magic) != 0)
        return {};
    std::string binary = content.substr(head);
    const bool whole = content.compare(magic.size(), digest_letters, text_digest(binary)) == 0;
    return whole ? binary : "";
}

void write_cached_program(const fs::path& file, const std::string& binary) {
    fs::create_directories(file.parent_path());
    // magic, digest of the rest, newline, binary
    write_text_atomically(file, std::string(magic) + text_digest(binary) + "\n" + binary);
}

} // namespace reradiant
