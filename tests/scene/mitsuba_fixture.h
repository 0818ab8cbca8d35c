#pragma once

#include "tests/scene/scratch.h"

#include "host/scene/mitsuba/mitsuba_import.h"
#include "reradiant/scene_file.h"

#include <string>

namespace reradiant::testing {

/// Lines 1 to 5: a sensor; what a test adds begins at line 6.
inline const std::string mitsuba_head = R"(<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="4"/></film>
</sensor>
)";

class MitsubaFixture : public Scratch {
protected:
    Scene load(const std::string& body) {
        return load_scene(write("scene.xml", mitsuba_head + body + "\n</scene>\n"));
    }
    Caught refusal(const std::string& body) {
        return error_of([&] { load(body); });
    }
    /// The material of a sphere with this bsdf.
    Material material(const std::string& bsdf) {
        return load("<shape type=\"sphere\">" + bsdf + "</shape>").materials.at(0);
    }
};

} // namespace reradiant::testing
