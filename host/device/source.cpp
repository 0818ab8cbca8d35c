#include "host/device/source.h"

#include "reradiant/error.h"

#include <fmt/core.h>

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

/// Source with its headers, each once (those in `seen` are there already).
class Expansion {
public:
    Expansion(const fs::path& root, const KernelDefines& defines) : root_(root) {
        for (const auto& [name, value] : defines)
            text_ += fmt::format("#define {} {}\n", name, value);
    }

    void add_file(const std::string& name) {
        if (!seen_.insert(name).second)
            return;
        std::ifstream stream(root_ / name);
        if (!stream)
            throw_runtime_error(
                fmt::format("cannot open the kernel source {}", (root_ / name).string()),
                "set RERADIANT_DATA to the folder that holds kernels");
        add(name, stream);
    }

    void add(const std::string& name, std::istream& stream) {
        text_ += fmt::format("#line 1 \"{}\"\n", name);
        std::string line;
        for (int number = 1; std::getline(stream, line); ++number) {
            const std::string file = included(line);
            if (file.empty()) {
                text_ += line + "\n";
                continue;
            }
            add_file(file);
            text_ += fmt::format("#line {} \"{}\"\n", number + 1, name);
        }
    }

    const std::string& text() const { return text_; }

private:
    const fs::path& root_;
    std::set<std::string> seen_;
    std::string text_;
};

} // namespace

std::string kernel_source(const fs::path& root, const std::string& file,
                          const KernelDefines& defines) {
    Expansion source(root, defines);
    source.add_file(file);
    return source.text();
}

std::string kernel_source_of_text(const fs::path& root, const std::string& name,
                                  const std::string& text, const KernelDefines& defines) {
    Expansion source(root, defines);
    std::istringstream stream(text);
    source.add(name, stream);
    return source.text();
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
