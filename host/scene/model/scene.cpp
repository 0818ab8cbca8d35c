#include "reradiant/scene.h"

#include "host/scene/model/fluorescence_ranges.h"
#include "host/scene/model/matrix_grids.h"

#include <stdexcept>

namespace reradiant {

const Spectrum& light_spectrum(const Light& light) {
    return std::visit(
        [](const auto& kind) -> const Spectrum& {
            if constexpr (requires { kind.intensity; })
                return kind.intensity;
            else if constexpr (requires { kind.irradiance; })
                return kind.irradiance;
            else
                return kind.radiance;
        },
        light);
}

bool Substrate::is_fluorescent() const {
    return !fluorescence_ranges(*this).is_empty();
}

std::optional<WavelengthGrid> Substrate::own_grid() const {
    return matrix ? common_grid({matrix.get()}) : std::nullopt;
}

std::array<double, 2> Substrate::excitation_range_nm() const {
    return fluorescence_ranges(*this).excitation;
}

std::array<double, 2> Substrate::emission_range_nm() const {
    return fluorescence_ranges(*this).emission;
}

Model model_from_name(const std::string& name) {
    for (const Model model : {Model::Auto, Model::Adding, Model::WeidlichWilkie, Model::Walk})
        if (name == model_name(model))
            return model;
    throw std::invalid_argument("no model is called \"" + name +
                                "\"; use auto, adding, weidlich-wilkie or walk");
}

const char* model_name(Model model) {
    switch (model) {
    case Model::Adding:
        return "adding";
    case Model::WeidlichWilkie:
        return "weidlich-wilkie";
    case Model::Walk:
        return "walk";
    default:
        return "auto";
    }
}

} // namespace reradiant
