// Layers of lights: they add up to the image, and each is what its lights alone would make.
#include "reradiant/error.h"
#include "tests/render/walk_strips.h"

#include <gtest/gtest.h>

#include <map>

namespace reradiant {
namespace {

using namespace test;

const WavelengthGrid wide_bands = grid_from_range(340, 700, 20);

/// Takes light from 340 to 420 nm and sends it out around 520.
Material brightened(std::vector<Layer> layers) {
    ReradiationMatrix matrix;
    matrix.emission = matrix.excitation = wide_bands;
    matrix.values = 0.5 * Eigen::MatrixXd::Identity(wide_bands.count, wide_bands.count);
    for (int i = 0; wide_bands.centre_nm(i) <= 420.0; ++i)
        for (int o = 7; o < 11; ++o)
            matrix.values(o, i) = 0.1;
    return fluorescent(std::move(layers), matrix);
}

/// A sphere over strips of materials, so that light goes to and fro, under one light of each type.
struct LitScene {
    Scene scene;
    RenderOptions options;
};

LitScene lit(const std::vector<Material>& materials) {
    LitScene lit{sphere_scene(materials.front(), 16, 16), {}};
    lit.scene.materials = materials;
    for (std::size_t m = 1; m < materials.size(); ++m) {
        const double z = -1.0 - static_cast<double>(m);
        lit.scene.shapes.push_back(
            {RectangleShape{{0, -1, z}, {0, 0, 8}, {8, 0, 0}}, static_cast<int>(m)});
    }
    lit.scene.lights = every_light.lights;
    lit.scene.lights.push_back(PointLight{{-2, 3, 3}, Spectrum::line(365.0, 10.0, 60.0)});
    lit.scene.lights.push_back(environment(Spectrum::table({400, 700}, {0.1, 0.9})));
    lit.scene.light_groups = {"day", "", "lamps", "lamps", "uv", "day"};
    lit.options.bands = wide_bands;
    lit.options.samples = 8;
    lit.options.light_groups = true;
    return lit;
}

LitScene with_options(LitScene lit, const std::function<void(RenderOptions&)>& set) {
    set(lit.options);
    return lit;
}

std::map<std::string, LitScene> scenes() {
    const std::vector<Material> closed = {brightened({layer(1.5)}), over_grey({tinted(layer(1.5))}),
                                          brightened({layer(1.5, 0.3)})};
    std::map<std::string, LitScene> all;
    all["smooth"] = lit({over_grey({layer(1.5)}), over_grey({})});
    all["rough"] = lit({over_grey({layer(1.5, 0.3)}), plaster_under({layer(1.4, 0.1)})});
    all["fluorescent"] = lit(closed);
    all["walk"] = with_options(lit(closed), [](RenderOptions& o) { o.model = Model::Walk; });
    all["hero"] = with_options(lit(closed), [](RenderOptions& o) { o.wavelengths.hero_count = 4; });
    all["band variance"] =
        with_options(lit(closed), [](RenderOptions& o) { o.band_variance = true; });
    all["adaptive"] = with_options(lit(closed), [](RenderOptions& o) { o.adaptive = true; });
    LitScene& image = all["environment image"] = lit(closed);
    image.scene.images = sky_image().images;
    image.scene.images[0].rgb[0] = 7.0f;
    image.scene.lights[1] = EnvironmentLight{Spectrum::constant(0.5), 0, 30.0};
    image.scene.lights.pop_back();
    return all;
}

void expect_sum(const RenderResult& result) {
    const auto bands_of = static_cast<std::size_t>(result.image.bands.count);
    double worst = 0.0;
    for (std::size_t first = 0; first < result.image.values.size(); first += bands_of) {
        double largest = 0.0, off = 0.0;
        for (std::size_t i = first; i < first + bands_of; ++i) {
            double sum = 0.0;
            for (const LightLayer& layer : result.light_layers)
                sum += static_cast<double>(layer.values[i]);
            const auto value = static_cast<double>(result.image.values[i]);
            largest = std::max(largest, value);
            off = std::max(off, std::abs(sum - value));
        }
        if (largest > 0.0)
            worst = std::max(worst, off / largest);
    }
    EXPECT_LT(worst, 1e-6) << "of the largest band of a pixel";
}

/// The names of a result's layers.
std::vector<std::string> names_of(const RenderResult& result) {
    std::vector<std::string> names;
    for (const LightLayer& layer : result.light_layers)
        names.push_back(layer.name());
    return names;
}

// Floats are added in another order: 1e-6 is some ten roundings.
TEST(LightLayers, AddUpToTheImageWhichStaysAsItIs) {
    for (auto& [name, lit] : scenes()) {
        SCOPED_TRACE(name);
        const RenderResult result = render(lit.scene, device(), lit.options);
        EXPECT_GE(result.light_layers.size(), 4u);
        expect_sum(result);
        lit.options.light_groups = false;
        const RenderResult plain = render(lit.scene, device(), lit.options);
        EXPECT_EQ(plain.image.values, result.image.values);
        EXPECT_TRUE(plain.light_layers.empty());
    }
}

TEST(LightLayers, AreNamedByGroupsAndPartsThatHoldLight) {
    auto all = scenes();
    EXPECT_EQ(names_of(render(all["smooth"].scene, device(), all["smooth"].options)),
              (std::vector<std::string>{"day", "environment:2", "lamps", "uv"}));
    const RenderResult result =
        render(all["fluorescent"].scene, device(), all["fluorescent"].options);
    EXPECT_EQ(
        names_of(result),
        (std::vector<std::string>{"day.uv", "day.visible", "environment:2.uv",
                                  "environment:2.visible", "lamps.uv", "lamps.visible", "uv.uv"}));
    EXPECT_EQ(result.light_layers[0].from_nm, 330.0);
    EXPECT_EQ(result.light_layers[0].to_nm, 390.0) << "400 is the first band that is visible";
    EXPECT_EQ(result.light_layers[1].to_nm, 710.0);
    EXPECT_TRUE(result.light_layers[0].lamp.empty()) << "the lights of `day` differ";
    ASSERT_EQ(result.light_layers[4].lamp.size(), std::size_t{lamp_cells});
    EXPECT_NEAR(result.light_layers[6].lamp[365 - lamp_from_nm], 6.0, 1e-9);
}

/// The scene with the lights of all groups but one switched off.
Scene lit_by(Scene scene, const std::string& group) {
    const std::vector<std::string>& names = scene.light_groups;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (names[i] != group)
            std::visit(
                [](auto& light) {
                    if constexpr (requires { light.radiance; })
                        light.radiance = Spectrum();
                    else if constexpr (requires { light.intensity; })
                        light.intensity = Spectrum();
                    else
                        light.irradiance = Spectrum();
                },
                scene.lights[i]);
    return scene;
}

// Sums over the image, by band, against the errors that both renders say of themselves.
TEST(LightLayers, AreWhatTheirLightsAloneMake) {
    LitScene lit = scenes()["fluorescent"];
    lit.options.samples = is_full_run() ? 1024 : 128;
    lit.options.band_variance = true;
    const RenderResult all = render(lit.scene, device(), lit.options);
    lit.options.light_groups = false;
    lit.options.seed = 7;
    const auto count = static_cast<std::size_t>(wide_bands.count);
    for (const char* group : {"day", "lamps", "uv"}) {
        SCOPED_TRACE(group);
        const SpectralImage alone = render(lit_by(lit.scene, group), device(), lit.options).image;
        SpectralImage layers = alone;
        std::fill(layers.values.begin(), layers.values.end(), 0.0f);
        for (const LightLayer& layer : all.light_layers)
            for (std::size_t i = 0; layer.group == group && i < layers.values.size(); ++i)
                layers.values[i] += layer.values[i];
        for (int band = 0; band < wide_bands.count; ++band) {
            double variance = 0.0, difference = 0.0;
            const std::size_t pixels = alone.values.size() / count;
            for (std::size_t p = 0; p < pixels; ++p) {
                const std::size_t i = p * count + static_cast<std::size_t>(band);
                difference += static_cast<double>(layers.values[i] - alone.values[i]);
                variance += static_cast<double>(alone.variance_bands[i]) +
                            static_cast<double>(all.image.variance_bands[i]);
            }
            EXPECT_LE(std::abs(difference),
                      sidak_bound(3.0 * wide_bands.count) * std::sqrt(variance) + 1e-6)
                << "band " << band;
        }
    }
}

TEST(LightLayers, NoneIsLeftOfLightsThatAreBlack) {
    LitScene dark = lit({over_grey({})});
    dark.scene = lit_by(dark.scene, "nothing");
    EXPECT_TRUE(render(dark.scene, device(), dark.options).light_layers.empty());
}

} // namespace
} // namespace reradiant
