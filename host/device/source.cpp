#include "host/device/source.h"

#include "host/error.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

/// The path inside `#include "..."`, or empty.
std::string included(const std::string& line) {
    constexpr std::string_view prefix = "#include \"";
    if (line.rfind(prefix, 0) != 0)
        return {};
    const std::size_t end = line.find('"', prefix.size());
    return end == std::string::npos ? "" : line.substr(prefix.size(), end - prefix.size());
}

void expand(const fs::path& root, const std::string& name, std::set<std::string>& seen,
            std::string& out) {
    if (!seen.insert(name).second)
        return;
    std::ifstream stream(root / name);
    if (!stream)
        throw_runtime_error(fmt::format("cannot open the kernel source {}", (root / name).string()),
                            "set RERADIANT_DATA to the folder that holds kernels");
    out += fmt::format("#line 1 \"{}\"\n", name);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::string file = included(line);
        if (file.empty()) {
            out += line + "\n";
            continue;
        }
        expand(root, file, seen, out);
        out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    }
}

} // namespace

std::string kernel_source(const fs::path& root, const std::string& file,
                          const KernelDefines& defines) {
    std::string source;
    for (const auto& [name, value] : defines)
        source += fmt::format("#define {} {}\n", name, value);
    std::set<std::string> seen;
    expand(root, file, seen, source);
    return source;
}

std::string text_digest(const std::string& text) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 1099511628211ull;
    }
    return fmt::format("{:016x}", hash);
}

} // namespace reradiant
