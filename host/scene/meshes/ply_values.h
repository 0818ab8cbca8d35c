#pragma once

#include "host/scene/meshes/ply_header.h"
#include "reradiant/error.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/core.h>

namespace reradiant {

/// A `PlyItem` is what a value belongs to; it is made into text for an error only.
struct PlyItem {
    std::string_view element;
    std::uint64_t index;

    std::string text() const { return fmt::format("{} {}", element, index); }
};

/// `PlyValues` reads the values after the header one by one, whatever the format.
class PlyValues {
public:
    PlyValues(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file.string()), bytes_(bytes), format_(header.format), next_(header.size),
          line_(header.line_count + 1), line_start_(header.size) {}

    /// The next value; integers up to 32 bits are exact as double.
    double next(PlyType type, const PlyItem& what) {
        return format_ == PlyFormat::Ascii ? next_ascii(what) : next_binary(type, what);
    }
    std::size_t remaining() const { return bytes_.size() - next_; }
    /// Returns true when something other than blanks is left.
    bool has_more();
    /// Returns line and column of the last value (ascii), else the file alone.
    SourcePosition position() const {
        if (format_ != PlyFormat::Ascii)
            return {file_};
        return {file_, line_, static_cast<int>(start_ - line_start_) + 1};
    }
    /// Returns " (at byte N)" for binary files, whose errors have no line; else nothing.
    std::string byte_text() const {
        return format_ == PlyFormat::Ascii ? "" : fmt::format(" (at byte {})", start_);
    }

private:
    void skip_blanks();
    double next_ascii(const PlyItem& what);
    double next_binary(PlyType type, const PlyItem& what);
    template <typename T>
    double decode(const unsigned char* bytes) const {
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return static_cast<double>(value);
    }

    std::string file_;
    std::string_view bytes_;
    PlyFormat format_;
    std::size_t next_, start_ = 0;
    int line_;
    std::size_t line_start_;
};

} // namespace reradiant
