#pragma once

#include "host/scene/toml/material_reader.h"

#include <map>

namespace reradiant {

/// Collects the materials of a scene and makes Scene::surfaces and Scene::materials of them.
class SurfaceBuilder {
public:
    /// The next [[material]].
    void add(MaterialReading reading) { readings_.push_back(std::move(reading)); }
    /// Resolves mixtures: `with` is a material of the scene, else a preset, which is appended.
    void finish(const std::map<std::string, int>& names, Scene& scene, LoadState& state);

private:
    int mixed_with(std::size_t surface, const std::map<std::string, int>& names, LoadState& state);
    void refuse_circles(const std::vector<int>& others) const;

    std::vector<MaterialReading> readings_;
    std::map<std::string, int> appended_presets_;
};

} // namespace reradiant
