// Lights apart, as users meet them: layers of a render, and the commands that read them.
#include "reradiant/spectral_image.h"
#include "tests/tools/program_runner.h"

#include <nlohmann/json.hpp>

namespace reradiant {

namespace {

const std::string shining = "reradiation = { fluorophores = [ { excitation = { gaussian_nm = 380, "
                            "sigma_nm = 40, scale = 0.8 }, emission = { gaussian_nm = 520, "
                            "sigma_nm = 20, scale = 1 }, quantum_yield = 0.9 } ], "
                            "reflectance = 0.3 }\n";

class LightGroups : public ProgramTest {
protected:
    void SetUp() override { put("scene.toml", scene("group = \"sky\"\n")); }

    /// Two lights: the sky, and a point beside it that sends ultraviolet light alone.
    static std::string scene(const std::string& of_sky) {
        std::string text = small_scene();
        text.insert(text.find("radiance"), of_sky);
        text.insert(text.find("[[shape]]"), "[[light]]\ntype = \"point\"\nposition = [2, 2, 2]\n"
                                            "intensity = { line_nm = 365, width_nm = 10, scale = "
                                            "90 }\n");
        const std::size_t at = text.find("reflectance");
        return text.replace(at, text.find('\n', at) + 1 - at, shining);
    }

    std::vector<float> values(const std::string& name) const {
        return read_spectral_exr(folder / name).values;
    }
    std::vector<LightLayer> layers(const std::string& name) const {
        std::vector<LightLayer> all;
        read_light_layers(folder / name,
                          [&](LightLayer&& layer) { all.push_back(std::move(layer)); });
        return all;
    }
    void expect_layers_near(const std::string& name, const std::string& reference,
                            float tolerance) const {
        const std::vector<LightLayer> a = layers(name), b = layers(reference);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_EQ(a[k].name(), b[k].name());
            for (std::size_t i = 0; i < a[k].values.size(); ++i)
                ASSERT_NEAR(a[k].values[i], b[k].values[i],
                            tolerance * std::max(1.0f, b[k].values[i]));
        }
    }
};

} // namespace

TEST_F(LightGroups, RenderKeepsThemAndSaysSo) {
    const ProgramResult result =
        run("render scene.toml -o out.exr --spp 4 --light-groups --json out.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("light groups: sky.uv, sky.visible, point:2.uv"),
              std::string::npos)
        << result.output;
    const auto json = nlohmann::json::parse(file_bytes(folder / "out.json"));
    ASSERT_EQ(json.at("light_layers").size(), 3u);
    EXPECT_EQ(json.at("light_layers")[2].at("name"), "point:2.uv");
    EXPECT_GT(json.at("light_layers")[2].at("mean_radiance").get<double>(), 0.0);
    const std::vector<LightLayer> kept = layers("out.exr");
    const std::vector<float> image = values("out.exr");
    for (std::size_t i = 0; i < image.size(); ++i)
        ASSERT_NEAR(kept[0].values[i] + kept[1].values[i] + kept[2].values[i], image[i],
                    1e-6f * std::max(1.0f, image[i]));
    const ProgramResult info = run("info out.exr");
    EXPECT_NE(info.output.find("name: point:2.uv"), std::string::npos) << info.output;
    ASSERT_EQ(run("render scene.toml -o plain.exr --spp 4").exit_code, 0);
    EXPECT_EQ(image, values("plain.exr"));
    EXPECT_EQ(run("compare out.exr plain.exr --max-relmse 1e-30").exit_code, 0);
}

TEST_F(LightGroups, DevelopAndProbeTurnThemUpAndDown) {
    ASSERT_EQ(run("render scene.toml -o out.exr --spp 4 --light-groups").exit_code, 0);
    const std::vector<LightLayer> kept = layers("out.exr");
    ASSERT_EQ(
        run("probe out.exr --at 4,3 --groups sky=0.5,sky.uv=0,point:2=3 --json p.json").exit_code,
        0);
    const auto json = nlohmann::json::parse(file_bytes(folder / "p.json"));
    const auto radiance = json.at("places")[0].at("radiance").get<std::vector<double>>();
    EXPECT_EQ(json.at("places")[0].at("radiance_stderr_from"), "unknown");
    for (std::size_t b = 0; b < radiance.size(); ++b) {
        const std::size_t i = (3 * 8 + 4) * radiance.size() + b;
        EXPECT_NEAR(radiance[b],
                    0.5 * static_cast<double>(kept[1].values[i]) +
                        3.0 * static_cast<double>(kept[2].values[i]),
                    1e-6);
    }
    ASSERT_EQ(run("develop out.exr -o all.png").exit_code, 0);
    ASSERT_EQ(run("develop out.exr -o ones.png --groups sky=1,point:2=1").exit_code, 0);
    EXPECT_EQ(file_bytes(folder / "all.png"), file_bytes(folder / "ones.png"));
    ASSERT_EQ(run("develop out.exr -o lamp.png --groups sky=0").exit_code, 0);
    EXPECT_NE(file_bytes(folder / "all.png"), file_bytes(folder / "lamp.png"));
    ASSERT_EQ(run("view out.exr -o page.html --json view.json").exit_code, 0);
    EXPECT_EQ(nlohmann::json::parse(file_bytes(folder / "view.json")).at("layers"), 3);
}

TEST_F(LightGroups, PartsAndInterruptedRendersMakeTheWhole) {
    ASSERT_EQ(run("render scene.toml -o whole.exr --spp 16 --light-groups").exit_code, 0);
    for (const char* range : {"0:6", "6:16"})
        ASSERT_EQ(run("render scene.toml -o " +
                      std::string(range == std::string("0:6") ? "a" : "b") +
                      ".exr --light-groups --sample-range " + range)
                      .exit_code,
                  0);
    const ProgramResult merged = run("merge b.exr a.exr -o all.exr");
    ASSERT_EQ(merged.exit_code, 0) << merged.errors;
    expect_layers_near("all.exr", "whole.exr", 1e-5f);
    ASSERT_EQ(run("render scene.toml -o c.exr --sample-range 16:20").exit_code, 0);
    expect_failure(2, "merge a.exr c.exr -o none.exr",
                   "the keeping of light groups is off, not on");

    std::string larger = scene("");
    larger.replace(larger.find("width = 8"), 9, "width = 40"); // there is time to interrupt it
    put("scene.toml", larger);
    ASSERT_EQ(run_until("kept.exr.checkpoint", "render scene.toml -o kept.exr --spp 3000 "
                                               "--light-groups --checkpoint 0.05"),
              130);
    expect_failure(2, "render scene.toml -o kept.exr --spp 3000 --resume",
                   "the keeping of light groups is off, not on");
    ASSERT_EQ(run("render scene.toml -o kept.exr --spp 3000 --light-groups --resume").exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o straight.exr --spp 3000 --light-groups").exit_code, 0);
    expect_layers_near("kept.exr", "straight.exr", 1e-5f);
}

TEST_F(LightGroups, WhatIsWrongIsSaidAndNothingWritten) {
    ASSERT_EQ(run("render scene.toml -o out.exr --spp 1 --light-groups").exit_code, 0);
    ASSERT_EQ(run("render scene.toml -o plain.exr --spp 1").exit_code, 0);
    put("grey.toml", "[material]\n[material.substrate]\ntype = \"lambert\"\nreflectance = 0.5\n");
    for (const char* name : {"", "a b", "a=b", "a.uv"}) {
        put("bad.toml", scene("group = \"" + std::string(name) + "\"\n"));
        expect_failure(2, "render bad.toml -o no.exr", "bad.toml:9:1: the name of a group");
    }
    expect_failure(2, "develop out.exr -o no.png --groups moon=1",
                   "out.exr: has no light group 'moon'; it has sky, sky.uv, sky.visible, point:2, "
                   "point:2.uv");
    expect_failure(2, "develop plain.exr -o no.png --groups sky=1", "holds no light groups");
    for (const char* text :
         {"sky", "sky=", "sky=-1", "sky=nan", "=1", "sky=1,sky=2", ",", "sky=1x"})
        expect_failure(2, "probe out.exr --at 1,1 -o no.csv --groups " + std::string(text),
                       "--groups");
    expect_failure(2, "view out.exr plain.exr -o no.html", "one picture");
    expect_failure(2, "view out.exr grey.toml -o no.html", "one picture");
    expect_failure(2, "view out.exr --glsl no.glsl", "no shader");
    expect_failure(2, "view out.exr", "no shader");
    put("black.toml",
        small_scene().replace(small_scene().find("radiance = 1"), 12, "radiance = 0"));
    ASSERT_EQ(run("render black.toml -o black.exr --spp 1 --light-groups").exit_code, 0);
    expect_failure(2, "view black.exr -o no.html", "black.exr: is black");
    expect_failure(2, "render scene.toml -o no.exr --light-groups --memory-limit 200000",
                   "the render would take");
}

} // namespace reradiant
