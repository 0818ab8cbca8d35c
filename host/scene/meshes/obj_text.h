#pragma once

#include "reradiant/error.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace reradiant {

/// The statements of an OBJ text and their words, with places. Lines end with LF, CR LF or CR; one
/// that ends with a backslash goes on in the next; '#' begins a comment.
class ObjText {
public:
    ObjText(const std::filesystem::path& file, std::string_view bytes)
        : file_(file.string()), rest_(bytes) {}

    /// Goes to the next line that does not continue another; false after the last.
    bool next_statement();
    /// The next word of the statement; empty at its end.
    std::string_view word();
    /// Returns the place of the last word, or of the end of the statement.
    SourcePosition position() const { return {file_, line_number_, column_}; }

private:
    void take_line();

    std::string file_;
    std::string_view rest_, line_, whole_line_;
    bool goes_on_ = false;
    int line_number_ = 0, column_ = 1;
};

} // namespace reradiant
