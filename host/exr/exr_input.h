#pragma once

#include "host/exr/exr_limits.h"
#include "reradiant/error.h"

#include <ImfMultiPartInputFile.h>

#include <fmt/core.h>

#include <filesystem>
#include <unistd.h>

namespace reradiant {

/// Opens an EXR file and hands it to `use`; whatever OpenEXR throws, on opening or within `use`,
/// becomes an input Error that names the file. Sizes beyond a film's 65536 are refused by the
/// header already.
template <typename Use>
auto with_exr_input(const std::filesystem::path& file, const Use& use) {
    std::error_code ignored;
    if (::access(file.c_str(), R_OK) != 0 || !std::filesystem::is_regular_file(file, ignored))
        throw_input_error({file.string()}, "cannot be opened",
                          "give an EXR file that exists and is readable");
    refuse_hostile_exr(file);
    try {
        constexpr bool reconstruct_offsets = false; // a table of zeros means an unfinished write
        Imf::MultiPartInputFile input(file.c_str(), 0, reconstruct_offsets);
        return use(input);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw_input_error({file.string()},
                          fmt::format("is no EXR file, or truncated or damaged ({})", error.what()),
                          "render or copy it again");
    }
}

} // namespace reradiant
