#include "tests/render/kernel_sizes.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// Bytes that a command prints.
std::size_t printed_bytes(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    if (!pipe)
        throw_runtime_error("this command does not run: " + command);
    std::array<char, 1 << 16> buffer{};
    std::size_t bytes = 0, got = 0;
    while ((got = std::fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0)
        bytes += got;
    if (bytes == 0)
        throw_runtime_error("this command printed nothing: " + command);
    return bytes;
}

} // namespace

std::size_t preprocessed_bytes(const fs::path& root, const KernelDefines& defines) {
    const fs::path text =
        fs::temp_directory_path() / fmt::format("reradiant-kernel-{}.c", ::getpid());
    std::size_t bytes = 0;
    for (const char* file :
         {"kernels/generate.cl", "kernels/shade.cl", "kernels/gather.cl", "kernels/film.cl"}) {
        std::ofstream(text) << kernel_source(root, file, defines);
        bytes += printed_bytes(
            fmt::format("cpp -P -D__OPENCL_VERSION__=120 '{}' | tr -s ' \\n'", text.string()));
    }
    fs::remove(text);
    return bytes;
}

std::size_t instruction_count(const fs::path& pocl_cache) {
    if (!fs::exists(pocl_cache))
        return 0;
    std::size_t instructions = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(pocl_cache))
        if (entry.path().extension() == ".so") // one line an instruction: address, tab, mnemonic
            instructions += printed_bytes(fmt::format(
                "objdump -d --no-show-raw-insn '{}' | grep '^ *[0-9a-f]*:.' | tr -dc '\\n'",
                entry.path().string()));
    return instructions;
}

} // namespace reradiant
