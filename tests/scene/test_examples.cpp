#include "reradiant/scene_file.h"
#include "tests/scene/scratch.h"

#include <cmath>
#include <fstream>
#include <set>

using namespace reradiant;
using namespace reradiant::testing;

namespace {

const std::filesystem::path SOURCE = RERADIANT_SOURCE_DIR;

double length(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

std::vector<std::filesystem::path> toml_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".toml")
            files.push_back(entry.path());
    return files;
}

/// Recipes of measurements lie beside the scenes.
bool is_scene(const std::filesystem::path& file) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
        if (line == "[film]")
            return true;
    return false;
}

/// Angle in degrees between a rectangle's normal and the direction from its centre to the camera.
double view_angle_deg(const RectangleShape& r, const Vector3& camera) {
    const Vector3 &u = r.edge_u, &v = r.edge_v;
    const Vector3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0]};
    const Vector3 to{camera[0] - r.centre[0], camera[1] - r.centre[1], camera[2] - r.centre[2]};
    const double cosine = (n[0] * to[0] + n[1] * to[1] + n[2] * to[2]) / (length(n) * length(to));
    return std::acos(cosine) * 180.0 / std::acos(-1.0);
}

} // namespace

TEST(Examples, EveryExampleLoadsWithoutAWarning) {
    const auto files = toml_files(SOURCE / "tools/examples");
    EXPECT_GE(files.size(), 9u);
    for (const auto& file : files) {
        if (!is_scene(file))
            continue;
        const auto warnings = warnings_of([&] { EXPECT_NO_THROW(load_scene(file)) << file; });
        EXPECT_TRUE(warnings.empty()) << file << ": " << warnings[0];
    }
}

TEST(Examples, EveryMaterialLoadsWithoutAWarning) {
    const auto files = toml_files(SOURCE / "spectra/materials");
    EXPECT_GE(files.size(), 3u);
    for (const auto& file : files) {
        const auto warnings = warnings_of([&] { EXPECT_NO_THROW(load_material(file)) << file; });
        EXPECT_TRUE(warnings.empty()) << file << ": " << warnings[0];
    }
}

/// Sheets are lit from behind, which no sphere is.
TEST(Examples, EveryPresetWithASubstrateIsOnTheContactSheet) {
    const Scene sheet = load_scene(SOURCE / "tools/examples/presets.toml");
    std::set<std::string> shown;
    for (const Surface& surface : sheet.surfaces) // those of mixtures come with them
        shown.insert(surface.name);
    for (const std::string& preset : preset_names()) {
        const Material material = load_material(SOURCE / "spectra/materials" / (preset + ".toml"));
        EXPECT_NE(shown.contains(preset), material.stack.is_sheet()) << preset;
    }
}

TEST(Examples, TheStudySeesItsSamplesAt5And20And60Degrees) {
    const double expected[] = {5.0, 20.0, 60.0};
    for (const char* coat : {"bare", "smooth", "rough"})
        for (const char* lamp : {"", "-405"}) {
            const Scene scene = load_scene(SOURCE / "tools/examples" /
                                           ("fluorescent-" + std::string(coat) + lamp + ".toml"));
            ASSERT_EQ(scene.shapes.size(), 3u);
            for (std::size_t i = 0; i < 3; ++i)
                // The file gives six digits: 1e-6 rad, and acos at 5 degrees is 12 times worse.
                EXPECT_NEAR(view_angle_deg(std::get<RectangleShape>(scene.shapes[i].geometry),
                                           scene.camera.origin),
                            expected[i], 1e-3);
            EXPECT_TRUE(scene.materials[0].substrate.is_fluorescent());
        }
}
