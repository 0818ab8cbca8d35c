// The plan of a render against what is built and allocated from it.
#include "host/render/film/device_film.h"
#include "host/render/plan/render_plan.h"
#include "host/render/wavefront/wavefront_buffers.h"
#include "reradiant/scene_file.h"
#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>

namespace reradiant {
namespace {

using namespace test;

struct Planned {
    Scene scene;
    RenderOptions options;
};

Planned planned(const std::vector<Material>& materials, Model model = Model::Auto) {
    Planned planned{strips_scene(materials), {}};
    planned.scene.lights = every_light.lights;
    planned.options.model = model;
    planned.options.batch_paths = 500;
    planned.options.bands = bands;
    return planned;
}

Planned example(const std::filesystem::path& file) {
    Planned planned{load_scene(file), {}};
    planned.scene.film.width = planned.scene.film.height = 9;
    planned.options.batch_paths = 500;
    return planned;
}

Image grey_image(float value) {
    return {"", 4, 2, std::vector<float>(24, value)};
}

Layer with_flakes(Layer of, Distribution distribution) {
    of.flakes = Flakes{0.4, gold_under({}, 0.3).substrate.conductor};
    of.flakes->reflector.distribution = distribution;
    return of;
}

/// A checker of two materials, mixed with a third, under an image and a black image.
Planned with_images() {
    Planned images = planned({over_grey({}), over_grey({layer(1.5)}), plaster_under({layer(1.3)})});
    Texture checker;
    checker.type = TextureType::Checker;
    checker.levels = 2;
    Texture shown;
    shown.type = TextureType::Image;
    shown.image = 0;
    Scene& scene = images.scene;
    scene.textures = {checker, shown, shown};
    scene.images = {grey_image(0.5f), grey_image(0.0f)};
    scene.surfaces = plain_surfaces(scene);
    scene.surfaces[0].textures = {0};
    scene.surfaces[2].mixed_with = 0;
    scene.materials[2].substrate.reflectance_image = 1;
    scene.lights.push_back(EnvironmentLight{Spectrum::constant(1.0), 0, 30.0});
    scene.lights.push_back(EnvironmentLight{Spectrum::constant(1.0), 1, 0.0});
    return images;
}

ReradiationMatrix anti_stokes() {
    ReradiationMatrix matrix = shifted_matrix();
    matrix.values(0, 5) = 0.01;
    return matrix;
}

std::map<std::string, Planned> generated() {
    const Layer film = [] {
        Layer coated = layer(1.5, 0.2);
        coated.film = ThinFilm{};
        return coated;
    }();
    Layer dispersive = layer(1.5, 0.2);
    dispersive.ior = Spectrum::table({400, 700}, {1.6, 1.5});
    const Layer cavities = rough(1.5, 0.3, Distribution::Blinn, Scattering::Multiple);
    std::map<std::string, Planned> all;
    all["bare"] = planned({over_grey({})});
    all["smooth"] = planned({over_grey({tinted(layer(1.5)), layer(1.3)})});
    all["rough"] = planned({over_grey({tinted(layer(1.5, 0.3)), layer(1.3), layer(1.6, 0.2)})});
    all["single"] = planned({over_grey({single(1.5, 0.3)})});
    all["clouded"] = planned({over_grey({clouded(layer(1.5), 0.3)})});
    all["plaster"] = planned({plaster_under({layer(1.5)}), over_fluorescent({layer(1.5)})});
    all["anti-Stokes"] = planned({fluorescent({layer(1.5, 0.2)}, anti_stokes())});
    all["walk"] = planned({over_fluorescent({clouded(layer(1.5, 0.3), 0.5), layer(1.3)}),
                           gold_under({tinted(layer(1.5))}, 0.3), plaster_under({cavities}),
                           over_grey({with_flakes(cavities, Distribution::Blinn)})},
                          Model::Walk);
    all["model A"] =
        planned({over_fluorescent({clouded(film, 0.5), with_flakes(layer(1.5), Distribution::Ggx)}),
                 gold_under({layer(1.5)}, 0.3), gold_under({}, 0.0),
                 over_grey({dispersive, layer(1.4, 0.1)}), over_grey({layer(1.0)})},
                Model::WeidlichWilkie);
    all["images"] = with_images();
    all["hero"] = planned({over_fluorescent({layer(1.5)}), over_grey({})});
    all["hero"].options.wavelengths.hero_count = 6;
    all["band variance"] = planned({over_grey({layer(1.5)})});
    all["band variance"].options.band_variance = true;
    all["adaptive"] = planned({over_grey({})});
    all["adaptive"].options.adaptive = true;
    all["light groups"] = planned({over_fluorescent({layer(1.5)}), over_grey({})});
    all["light groups"].options.light_groups = true;
    all["images in groups"] = with_images();
    all["images in groups"].options.light_groups = true;
    all["all features"] = planned({over_grey({layer(1.5)})});
    all["all features"].options.all_features = true;
    return all;
}

void expect_foreseen(const std::string& name, const Planned& planned) {
    SCOPED_TRACE(name);
    const RenderPlan plan = plan_render(planned.scene, device().info(), planned.options);
    const SceneTables tables = build_scene_tables(planned.scene, plan);
    const WavefrontBuffers buffers(device(), plan, tables);
    const DeviceFilm film(device(), plan.film, static_cast<std::uint32_t>(plan.pixels));
    const std::size_t films = 1 + buffers.layer_lights.size();
#define BUFFER(type, name) EXPECT_EQ(buffers.name.size(), plan.counts.name) << #name;
    RENDER_BUFFERS(BUFFER)
#undef BUFFER
    EXPECT_EQ(films * film.float_count(), plan.counts.sums + plan.counts.statistics);
    EXPECT_EQ(buffers.bytes() + films * film.bytes(), plan.device_bytes());
    EXPECT_LE(tables.tables.size(), plan.counts.tables) << "what the tables' copy is foreseen as";
}

TEST(RenderPlan, ForeseesEveryBufferOfGeneratedScenes) {
    for (const auto& [name, planned] : generated())
        expect_foreseen(name, planned);
}

TEST(RenderPlan, ForeseesEveryBufferOfTheExamples) {
    const std::filesystem::path folder = RERADIANT_SOURCE_DIR "/tools/examples";
    for (const char* name :
         {"fluorescent-bare", "fluorescent-room", "fluorescent-rough", "fluorescent-smooth-405",
          "furnace", "presets", "reference-study", "uv-only"})
        expect_foreseen(name, example(folder / (std::string(name) + ".toml")));
}

TEST(RenderPlan, RendersTakeTheBytesThatItForesees) {
    Planned in_groups = with_images();
    in_groups.options.light_groups = true;
    for (const Planned& planned :
         {planned({over_fluorescent({layer(1.5)})}), with_images(), in_groups}) {
        RenderOptions options = planned.options;
        options.samples = 1;
        EXPECT_EQ(render(planned.scene, device(), options).device_bytes,
                  plan_render(planned.scene, device().info(), options).device_bytes());
    }
}

TEST(RenderPlan, LeavesOutBuffersThatAreNotNeeded) {
    const Planned bare = planned({over_grey({})});
    std::vector<std::string> names;
    for (const BufferPlan& buffer :
         plan_render(bare.scene, device().info(), bare.options).buffers()) {
        EXPECT_GT(buffer.count, 0u) << buffer.name;
        names.push_back(buffer.name);
    }
    for (const char* name : {"layers", "lobes", "textures", "walk_parts", "colours", "lobe_weights",
                             "walk_chunks", "walk_vertices", "hero_lanes", "chosen"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
    EXPECT_EQ(std::count(names.begin(), names.end(), "vertices"), 1);
}

TEST(RenderPlan, RefusesByWhatItForesees) {
    Planned small = planned({over_grey({layer(1.5)})});
    const RenderPlan plan = plan_render(small.scene, device().info(), small.options);
    small.options.memory_limit_bytes = plan.device_bytes() + plan.host_bytes;
    EXPECT_NO_THROW(plan_render(small.scene, device().info(), small.options));
    --small.options.memory_limit_bytes;
    EXPECT_THROW(plan_render(small.scene, device().info(), small.options), Error);
}

TEST(RenderPlan, EveryLightLayerTakesAFilm) {
    Planned lit = planned({over_fluorescent({layer(1.5)})});
    const std::uint64_t alone = plan_render(lit.scene, device().info(), lit.options).counts.sums;
    lit.options.light_groups = true;
    const RenderPlan plan = plan_render(lit.scene, device().info(), lit.options);
    EXPECT_GE(plan.lights.layers.size(), lit.scene.lights.size());
    EXPECT_EQ(plan.counts.sums, plan.films() * alone);
    lit.options.memory_limit_bytes = plan.device_bytes() + plan.host_bytes - 1;
    EXPECT_THROW(plan_render(lit.scene, device().info(), lit.options), Error);
}

TEST(RenderPlan, BlackEnvironmentsNeedNothing) {
    Planned dark = planned({over_grey({})});
    dark.scene.images = {grey_image(0.0f)};
    dark.scene.lights = {EnvironmentLight{Spectrum::constant(1.0), 0, 0.0}, environment(Spectrum()),
                         directional(0.0, 0.0, Spectrum::constant(1.0))};
    const RenderPlan plan = plan_render(dark.scene, device().info(), dark.options);
    EXPECT_FALSE(plan.features.environment_image);
    EXPECT_FALSE(plan.features.environment);
    EXPECT_TRUE(plan.features.delta_lights);
    EXPECT_EQ(plan.counts.colours, 0u);
}

TEST(RenderPlan, OfSeveralRefusedMaterialsTheFirstIsNamed) {
    Layer dyed = layer(1.5);
    dyed.dyes = {
        {Spectrum::constant(1.0), 1.0, Spectrum::gaussian(600.0, 20.0, 1.0), 0.5, nullptr}};
    std::vector<Material> materials(40, over_grey({layer(1.5)}));
    for (std::size_t i = 10; i < materials.size(); ++i)
        materials[i] = over_grey({dyed});
    for (std::size_t i = 0; i < materials.size(); ++i)
        materials[i].name = std::to_string(i);
    Planned refused = planned(materials, Model::Adding);
    refused.options.wavelengths.hero_count = 4;
    for (int run = 0; run < 20; ++run) {
        try {
            plan_render(refused.scene, device().info(), refused.options);
            ADD_FAILURE() << "dyes do not go with hero wavelengths";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("material '10'"), std::string::npos)
                << error.what();
        }
    }
}

} // namespace
} // namespace reradiant
