// Sliders, lamps, shapes, keys and files of a page, used as its reader uses them.
#include "host/layers/models/layered_bsdf.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "reradiant/measure.h"
#include "tests/view/shown_page.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace reradiant {

namespace {

/// Largest error of a reading's bands, relative or to a thousandth of the largest band.
double error_of(const nlohmann::json& reading, const Material& material, Model model) {
    const WavelengthGrid bands = measured_bands(material, {});
    const LayeredBsdf surface(material.stack, measured_substrate(material.substrate, bands), bands,
                              closed_model(model));
    const auto vec3 = [&](const char* key) {
        const auto w = reading.at(key).get<std::vector<double>>();
        return kernels::vec3(w[0], w[1], w[2]);
    };
    const auto light = reading.at("light").get<std::vector<double>>();
    const auto radiance = reading.at("radiance").get<std::vector<double>>();
    const Eigen::VectorXd exact =
        surface.eval(vec3("wi"), vec3("wo")) *
        Eigen::Map<const Eigen::VectorXd>(light.data(), static_cast<Eigen::Index>(light.size())) *
        vec3("wi").z;
    double largest = 0.0;
    for (std::size_t band = 0; band < radiance.size(); ++band) {
        const double value = exact(static_cast<Eigen::Index>(band));
        largest = std::max(largest, std::fabs(radiance[band] - value) /
                                        std::max(value, 1e-3 * exact.maxCoeff()));
    }
    return largest;
}

class PageControls : public ShownPage {};

} // namespace

// Sliders change the material as its file would; between tabulated widths values are interpolated.
TEST_F(PageControls, SlidersDoWhatTheirKeysDo) {
    ViewedMaterial viewed = viewed_preset("fluorescent-orange-rough");
    const nlohmann::json outcome = opened(page_of(viewed), hands + R"js(
  drag('thickness', 2); drag('absorption', 1.5); drag('alpha', 0.1);
  outcome.node = told(shown());
  pick('model', 'weidlich-wilkie');
  outcome.closed = told(shown());
  drag('alpha', 0.14);
  outcome.closed_between = told(shown());
  pick('model', 'adding');
  outcome.between = told(shown());
  place('reset').click();
  outcome.own = told(shown());
)js");
    Layer& layer = viewed.material.stack.layers.front();
    EXPECT_LT(error_of(outcome.at("own"), viewed.material, Model::Adding), 0.01);
    layer.thickness *= 2.0;
    layer.absorption = layer.absorption.scaled(1.5);
    layer.alpha = 0.1;
    EXPECT_LT(error_of(outcome.at("node"), viewed.material, Model::Adding), 0.01);
    EXPECT_LT(error_of(outcome.at("closed"), viewed.material, Model::WeidlichWilkie), 0.001);
    layer.alpha = 0.14;
    // only what facets interreflect is interpolated
    EXPECT_LT(error_of(outcome.at("closed_between"), viewed.material, Model::WeidlichWilkie), 0.01);
    EXPECT_LT(error_of(outcome.at("between"), viewed.material, Model::Adding), 0.03);
}

TEST_F(PageControls, SmoothVarnishIsMadeRough) {
    ViewedMaterial viewed = viewed_preset("neon-orange-varnished");
    const nlohmann::json outcome = opened(page_of(viewed), hands + R"js(
  drag('alpha', 0.2);
  outcome.rough = told(shown());
)js");
    viewed.material.stack.layers.front().alpha = 0.2;
    EXPECT_LT(error_of(outcome.at("rough"), viewed.material, Model::Adding), 0.01);
}

// Without its dye the body is dark under an ultraviolet lamp; half of the dye sends out about half.
TEST_F(PageControls, DyeAndUltravioletDoWhatTheyShould) {
    const nlohmann::json outcome =
        opened(page_of(viewed_preset("fluorescent-orange-bare")), hands + R"js(
  pick('lamp', String(lamps.findIndex((lamp) => lamp.name === 'L:365:10')));
  const luminance = () => { const { weights } = materialNow(); return xyzOf(shown().radiance, weights)[1]; };
  outcome.whole = luminance();
  drag('dye', 0.5);
  outcome.half = luminance();
  drag('dye', 0);
  outcome.none = luminance();
  drag('dye', 1); drag('uv', 0);
  outcome.dark = luminance();
)js");
    const double whole = outcome.at("whole");
    EXPECT_GT(whole, 0.0);
    EXPECT_NEAR(outcome.at("half").get<double>() / whole, 0.5, 0.01);
    // the eye sees a little of 370 nm, which is reflected
    EXPECT_LT(outcome.at("none").get<double>(), 1e-4 * whole);
    EXPECT_EQ(outcome.at("dark"), 0.0);
}

// The TOML and the matrix that the page hands out are the material that it shows.
TEST_F(PageControls, CopiedFilesAreTheMaterialAsItStands) {
    const nlohmann::json outcome =
        opened(page_of(viewed_preset("fluorescent-orange-rough")), hands + R"js(
  drag('thickness', 0.5); drag('alpha', 0.35); drag('dye', 0.6);
  outcome.reading = told(shown());
  outcome.toml = place('toml').textContent;
  outcome.csv = matrixCsv(materialNow(), view.sliders);
  outcome.csv_name = matrixFileName(materialNow());
)js");
    std::ofstream(folder / "copied.toml") << outcome.at("toml").get<std::string>();
    std::ofstream(folder / outcome.at("csv_name").get<std::string>())
        << outcome.at("csv").get<std::string>();
    EXPECT_LT(error_of(outcome.at("reading"), load_material(folder / "copied.toml"), Model::Adding),
              0.01);
}

TEST_F(PageControls, EveryPresetsCopyIsReadAgain) {
    for (const char* preset : {"pearlescent-paint", "patina", "house-paint", "lepidolite-flake",
                               "multi-layer", "fluorescent-pigment"}) {
        const nlohmann::json outcome = opened(page_of(viewed_preset(preset)), hands + R"js(
  pick('model', 'weidlich-wilkie');
  outcome.reading = told(shown());
  outcome.toml = place('toml').textContent;
  outcome.csv = matrixCsv(materialNow(), view.sliders);
  outcome.csv_name = matrixFileName(materialNow());
)js");
        std::ofstream(folder / "copied.toml") << outcome.at("toml").get<std::string>();
        std::ofstream(folder / outcome.at("csv_name").get<std::string>())
            << outcome.at("csv").get<std::string>();
        EXPECT_LT(error_of(outcome.at("reading"), load_material(folder / "copied.toml"),
                           Model::WeidlichWilkie),
                  0.002)
            << preset;
    }
}

TEST_F(PageControls, LampsOfOnesOwnAreTakenOrRefusedWithTheLine) {
    const nlohmann::json outcome = opened(page_of(viewed_preset("neon-orange-bare")), hands + R"js(
  const paste = async (text) => { place('lamp-text').value = text; place('take-lamp').click();
    await new Promise((done) => setTimeout(done, 50)); return place('message').textContent; };
  outcome.good = await paste('nm,W\n400,0\n410 1\n420;0\n');
  outcome.light = lampNow().map((value) => value > 0);
  outcome.descending = await paste('500 1\n400 1\n');
  outcome.words = await paste('400 1\n410 much\n');
  outcome.negative = await paste('400 1\n410 -1\n');
  outcome.dark = await paste('100 1\n200 1\n');
  outcome.lamps = lamps.length;
)js");
    EXPECT_EQ(outcome.at("good"), "my lamp is lit");
    int lit = 0;
    for (const nlohmann::json& is_lit : outcome.at("light"))
        lit += is_lit.get<bool>() ? 1 : 0;
    EXPECT_EQ(lit, 3) << "bands of 10 nm at 400, 410 and 420 nm";
    for (const auto& [key, words] : {std::pair{"descending", "line 2: wavelengths must ascend"},
                                     {"words", "line 2 has no two numbers"},
                                     {"negative", "line 2: a lamp sends out no negative light"},
                                     {"dark", "dark from 280"}})
        EXPECT_NE(outcome.at(key).get<std::string>().find(words), std::string::npos) << outcome;
    EXPECT_EQ(outcome.at("lamps"), 11);
}

TEST_F(PageControls, FlatSamplesAndOwnShapesAreReadAsTheyAreDrawn) {
    const nlohmann::json outcome =
        opened(page_of(viewed_preset("neon-orange-varnished")), hands + R"js(
  drag('around', 0.3); drag('radius', 6);
  outcome.worst = 0;
  const compare = (name) => { shown(); let hits = 0;
    for (let x = 60.5; x < SIZE; x += 57) for (let y = 60.5; y < SIZE; y += 57) {
      const found = readingAt(states[view.model], x, y), pixel = drawn(x, y);
      if (!found) continue;
      ++hits;
      outcome.worst = Math.max(outcome.worst, ...found.rgb.map((value, k) => Math.abs(255 * value - pixel[k])));
    }
    outcome[name] = hits; };
  for (const shape of ['flat5', 'flat20', 'flat60']) {
    pick('shape', shape);
    outcome[shape + '_angle'] = readingAt((shown(), states[view.model]), 256, 256).thetaO;
    compare(shape);
  }
  takeMesh('v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n', 'square.obj');
  compare('square');
  takeMesh('ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n' +
    'element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n0 1.7 0\n3 0 1 2\n', 'one.ply');
  compare('triangle');
  const refused = (text) => { try { meshFromText(text, ''); return ''; } catch (error) { return error.message; } };
  outcome.empty = refused('# nothing');
  outcome.index = refused('v 0 0 0\nf 1 2 3\n');
)js");
    EXPECT_NEAR(outcome.at("flat5_angle").get<double>(), 5.0, 0.2);
    EXPECT_NEAR(outcome.at("flat20_angle").get<double>(), 20.0, 0.2);
    EXPECT_NEAR(outcome.at("flat60_angle").get<double>(), 60.0, 0.2);
    for (const char* shape : {"flat5", "flat20", "flat60", "square", "triangle"})
        EXPECT_GE(outcome.at(shape).get<int>(), 4) << shape;
    EXPECT_LT(outcome.at("worst").get<double>(), 1.5) << outcome.dump();
    EXPECT_NE(outcome.at("empty").get<std::string>().find("no triangles"), std::string::npos);
    EXPECT_NE(outcome.at("index").get<std::string>().find("line 2"), std::string::npos);
}

} // namespace reradiant
