#include "tools/commands/colour/colour_options.h"

#include "host/scene/lights/lamp_file.h"
#include "reradiant/error.h"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

namespace reradiant {

namespace {

/// The names between commas; one that is empty is a slip.
std::vector<std::string> split_names(const std::vector<std::string>& given, const char* option) {
    std::vector<std::string> names;
    for (const std::string& list : given) {
        std::istringstream parts(list + ',');
        for (std::string name; std::getline(parts, name, ',');) {
            if (name.empty())
                throw_input_error({}, fmt::format("{}: a name is missing in '{}'", option, list),
                                  "write names between commas, as in D65,A");
            names.push_back(name);
        }
    }
    return names;
}

/// Errors of a word name its option.
template <typename Make>
auto named_by(const char* option, const Make& make) {
    try {
        return make();
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("{}: {}", option, error.what()));
    }
}

/// Two lamps of one name would have one key.
void require_new(const std::vector<Lamp>& lamps, const std::string& name) {
    for (const Lamp& lamp : lamps)
        if (lamp.name == name)
            throw_input_error({}, fmt::format("lamp '{}' is asked for twice", name),
                              "name every lamp once");
}

} // namespace

void read_conditions(ColourOptions& options) {
    if (options.illuminants.empty() && options.lamp_files.empty())
        options.illuminants = {"D65"};
    for (const std::string& name : split_names(options.illuminants, "--illuminant")) {
        require_new(options.lamps, name);
        options.lamps.push_back(named_by("--illuminant", [&] { return lamp_from_text(name); }));
    }
    for (const std::filesystem::path& file : options.lamp_files) {
        require_new(options.lamps, file.filename().string());
        options.lamps.push_back(read_lamp_file(file));
    }
    if (options.uv_cut_nm)
        for (Lamp& lamp : options.lamps)
            lamp =
                named_by("--uv-cut", [&] { return without_ultraviolet(lamp, *options.uv_cut_nm); });
    for (const std::string& name : split_names(options.observer_names, "--observer"))
        options.observers.push_back(named_by("--observer", [&] { return observer_named(name); }));
}

} // namespace reradiant
