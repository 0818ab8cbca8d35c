#include "host/study/converge/render_method.h"

#include "reradiant/error.h"
#include "reradiant/wavelength_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace reradiant {

namespace {

constexpr int most_comb_wavelengths = 4096;
constexpr const char* remedy =
    "a method is a model (auto, adding, weidlich-wilkie, walk), a wavelength sampling (comb or "
    "comb:N with N from 1 to 4096, hero or hero:N with N from 1 to 16), adaptive, or several "
    "joined by a plus, as in "
    "MODEL+comb:N";

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

[[noreturn]] void refuse(const std::string& method, const std::string& why) {
    throw std::invalid_argument(fmt::format("'{}' {}; {}", method, why, remedy));
}

bool is_sampling(const std::string& part, const std::string& name) {
    return part == name || part.starts_with(name + ":");
}

/// N of NAME:N, or `otherwise` without it.
int wavelength_count(const std::string& method, const std::string& part, const std::string& name,
                     int otherwise, int most) {
    if (part == name)
        return otherwise;
    int count = 0;
    const char* const end = part.data() + part.size();
    const auto [stop, code] = std::from_chars(part.data() + name.size() + 1, end, count);
    if (code != std::errc{} || stop != end || count < 1 || count > most)
        refuse(method, "has no valid count of wavelengths");
    return count;
}

Model model_of(const std::string& method, const std::string& part) {
    try {
        return model_from_name(part);
    } catch (const std::invalid_argument&) {
        refuse(method, fmt::format("holds the unknown part '{}'", part));
    }
}

} // namespace

std::string RenderMethod::file_stem() const {
    std::string stem = name;
    std::replace(stem.begin(), stem.end(), ':', '-');
    return stem;
}

RenderMethod parse_method(const std::string& text) {
    RenderMethod method{text};
    bool has_model = false, has_sampling = false;
    for (const std::string& part : split(text, '+')) {
        if (part == "adaptive") {
            if (method.adaptive)
                refuse(text, "says adaptive twice");
            method.adaptive = true;
            continue;
        }
        const bool comb = is_sampling(part, "comb"), hero = is_sampling(part, "hero");
        if (comb)
            method.comb_count = wavelength_count(text, part, "comb", 0, most_comb_wavelengths);
        else if (hero)
            method.hero_count = wavelength_count(text, part, "hero", default_hero_wavelengths,
                                                 most_hero_wavelengths);
        else
            method.model = model_of(text, part);
        bool& given = comb || hero ? has_sampling : has_model;
        if (given)
            refuse(text, comb || hero ? "names two wavelength samplings" : "names two models");
        given = true;
    }
    return method;
}

std::vector<RenderMethod> parse_methods(const std::string& list) {
    std::vector<RenderMethod> methods;
    try {
        for (const std::string& text : split(list, ',')) {
            RenderMethod method = parse_method(text);
            const bool known = std::any_of(methods.begin(), methods.end(), [&](const auto& other) {
                return other.name == method.name;
            });
            if (known)
                refuse(text, "is named twice");
            methods.push_back(std::move(method));
        }
    } catch (const std::invalid_argument& error) {
        throw_input_error({}, fmt::format("--methods: {}", error.what()));
    }
    return methods;
}

} // namespace reradiant
