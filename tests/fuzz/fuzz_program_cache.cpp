#include "host/device/program_cache.h"
#include "tests/fuzz/fuzz_input.h"

// Entries of the kernel cache. The only file that is taken is one that writing gives.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string_view text = fuzz::text_of(bytes, size);
    const auto file = fuzz::put("program.bin", text);
    const std::string binary = read_cached_program(file);
    if (binary.empty())
        return 0;
    const std::size_t head = text.size() - binary.size();
    if (binary != text.substr(head) || head < sizeof("reradiant-program-1"))
        fuzz::fail("a binary that is not the rest of its file");
    return 0;
}
