#pragma once

#include <stdexcept>
#include <string>

namespace reradiant {

/// A place in an input file. Line and column count from 1; 0 means "not known".
struct SourcePosition {
    std::string file;
    int line = 0;
    int column = 0;

    /// "FILE:LINE:COLUMN", leaving out what is not known.
    std::string text() const;
};

/// The one exception of the project: what is wrong, where, and what would be right.
/// Input errors end the program with exit code 2, run-time failures (device, disk) with 1.
class Error : public std::runtime_error {
public:
    enum class Kind { Input, Runtime };

    Error(Kind kind, const SourcePosition& position, const std::string& what_is_wrong,
          const std::string& remedy = {});

    Kind kind() const { return kind_; }
    const SourcePosition& position() const { return position_; }
    /// 2 for input errors, 1 for run-time failures.
    int exit_code() const { return kind_ == Kind::Input ? 2 : 1; }

private:
    Kind kind_;
    SourcePosition position_;
};

/// "FILE:LINE:COLUMN: what is wrong; remedy", exit code 2.
[[noreturn]] void throw_input_error(const SourcePosition& position,
                                    const std::string& what_is_wrong,
                                    const std::string& remedy = {});

/// A failure that no change of the input would cure, exit code 1.
[[noreturn]] void throw_runtime_error(const std::string& what_is_wrong,
                                      const std::string& remedy = {});

} // namespace reradiant
