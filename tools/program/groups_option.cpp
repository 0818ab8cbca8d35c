#include "tools/program/groups_option.h"

#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace reradiant {

void add_groups_option(Command& command, std::string& text) {
    command.option("--groups", text,
                   "factors of the light groups of an image of `render --light-groups`, as "
                   "NAME=FACTOR,...; lights without one keep theirs");
}

LightFactors parse_groups_option(const std::string& text) {
    LightFactors factors;
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::string_view piece = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(piece.size() + 1, rest.size()));
        const std::size_t equals = piece.find('=');
        double factor = -1.0;
        if (equals != std::string_view::npos && equals > 0) {
            const std::string_view number = piece.substr(equals + 1);
            const char* const end = number.data() + number.size();
            const auto read = std::from_chars(number.data(), end, factor);
            if (read.ec != std::errc() || read.ptr != end)
                factor = -1.0;
        }
        if (!std::isfinite(factor) || factor < 0.0)
            throw_input_error({}, fmt::format("--groups: '{}' is no factor of a group", piece),
                              "write NAME=FACTOR with a factor from 0 on, as in window=0.5,uv=2");
        if (!factors.emplace(piece.substr(0, equals), factor).second)
            throw_input_error({}, fmt::format("--groups names '{}' twice", piece.substr(0, equals)),
                              "give each group one factor");
    }
    return factors;
}

SpectralImage read_image(const std::filesystem::path& file, const LightFactors& factors) {
    return factors.empty() ? read_spectral_exr(file) : read_relit_image(file, factors);
}

} // namespace reradiant
