#pragma once

#include "reradiant/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace reradiant::fuzz {

/// The bytes of one execution, as text.
inline std::string_view text_of(const std::uint8_t* bytes, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes), size};
}

/// A folder of this process, in memory where the system has a place for that; it goes with the
/// process. The first call also points the caches and $HOME into it.
const std::filesystem::path& folder();

/// Writes a file of this name into the folder, over what it held before.
std::filesystem::path put(const std::string& name, std::string_view bytes);

/// Prints why and ends the process, so that the fuzzer keeps the input.
[[noreturn]] void fail(const std::string& why);

/// Fails unless the number is finite: readers refuse infinities and NaN.
void require_finite(double value, const char* what);
template <typename Values>
void require_all_finite(const Values& values, const char* what) {
    for (const auto value : values)
        require_finite(static_cast<double>(value), what);
}

/// The contract of every reader: `read` returns, or throws an input Error that says something.
/// Any other exception is a failure, and so is a crash, a hang, or more memory than allowed, which
/// the fuzzer and the replay see from outside.
template <typename Read>
void read_or_refuse(const Read& read) {
    try {
        read();
    } catch (const Error& error) {
        if (error.kind() != Error::Kind::Input)
            fail(std::string("a run-time Error for bad input: ") + error.what());
    } catch (const std::exception& error) {
        fail(std::string("an exception that is no Error: ") + error.what());
    }
}

} // namespace reradiant::fuzz

/// libFuzzer's entry point; every target of this folder defines it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
