#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace reradiant {

/// A `TextFormat` is what a text says it is, in its own first words. A `Table` names no other
/// format: it has lines of numbers with comments and headings.
enum class TextFormat { Table, JcampDx, Cgats, Tm27, Bfc, Xml, Html, Json, IesPhotometry };

/// "a JCAMP-DX spectrum" and so on, for messages.
std::string_view text_format_name(TextFormat format);

/// Reads a text file as plain_text has it. Input Error when it cannot be read, is over 64 MiB, or
/// is no text: a Zip archive (.xlsx, .ods), an OpenEXR image, UTF-16 and so on, by name.
std::string read_text_file(const std::filesystem::path& file);

/// Format of a text that read_text_file returned.
TextFormat text_format(std::string_view text);
/// Returns the format of a file, as text_format does for its text.
TextFormat text_format_of(const std::filesystem::path& file);

} // namespace reradiant
