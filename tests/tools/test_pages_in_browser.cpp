// The pages of `study`, `converge` and `colour` in headless Chromium, used as a reader uses them.
#include "tests/support/page_browser.h"
#include "tests/tools/program_runner.h"

#include <cstdio>

namespace reradiant {

namespace {

class PagesInBrowser : public ProgramTest {
protected:
    void SetUp() override {
        if (!browser_.is_there())
            GTEST_SKIP() << PageBrowser::missing;
        put("scene.toml", small_scene());
    }

    nlohmann::json opened(const std::string& page, const std::string& steps) const {
        return browser_.opened(folder / "", file_bytes(folder / page), steps);
    }

    static void expect_sound(const nlohmann::json& outcome, int pictures) {
        EXPECT_EQ(outcome.at("faults"), nlohmann::json::array());
        EXPECT_EQ(outcome.at("fetched"), nlohmann::json::array()) << "pages need no network";
        EXPECT_EQ(outcome.at("broken"), 0);
        EXPECT_GE(outcome.at("pictures"), pictures);
    }

    PageBrowser browser_;
};

} // namespace

TEST_F(PagesInBrowser, StudyIsPickedDraggedAndReadUnderThePointer) {
    put("study.toml", "[study]\nscene = \"scene.toml\"\n[render]\nspp = 16\n[measure]\n"
                      "[[sweep]]\nkey = \"material.grey.substrate.reflectance\"\n"
                      "values = [0.2, 0.8]\n");
    ASSERT_EQ(run("study study.toml -o results").exit_code, 0);
    const nlohmann::json outcome = opened("results/index.html", R"js(
  const all = (selector) => [...document.querySelectorAll(selector)];
  const point = (canvas, x, y, buttons) => {
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent('pointermove', { buttons,
      clientX: box.left + x * box.width, clientY: box.top + y * box.height }));
  };
  const drag = (id, value) => {
    const slider = document.getElementById(id);
    slider.value = value;
    slider.dispatchEvent(new Event('input'));
  };
  outcome.cells = all('#sheet button').length;
  outcome.panels_at_first = all('.panel').length;
  all('#sheet button')[1].click();
  outcome.panels = all('.panel').length;
  drag('nm', 600);
  const second = all('.panel')[1];
  point(second.querySelector('canvas.image'), 0.55, 0.6, 0);
  outcome.pixel = second.querySelectorAll('.value')[0].textContent;
  point(second.querySelectorAll('canvas:not(.image)')[0], 0.5, 0.5, 1); // dragged to the middle
  outcome.dragged = Number(document.getElementById('nm').value);
  drag('excitation', 450);
  const matrix = second.querySelectorAll('canvas.image')[1];
  point(matrix, 0.5, 0.5, 0);
  outcome.matrix = [...second.querySelectorAll('.value')].map((v) => v.textContent)
    .find((t) => / nm to /.test(t));
  document.getElementById('single').click();
  outcome.first_still = all('.panel')[0].querySelector('.value').textContent;
  all('#sheet button')[0].click();
  outcome.panels_at_last = all('.panel').length;
)js");
    expect_sound(outcome, 2);
    EXPECT_EQ(outcome.at("cells"), 2);
    EXPECT_EQ(outcome.at("panels_at_first"), 1);
    EXPECT_EQ(outcome.at("panels"), 2);
    EXPECT_EQ(outcome.at("panels_at_last"), 1);
    const std::string pixel = outcome.at("pixel");
    int x = 0, y = 0;
    double radiance = 0.0, nm = 0.0;
    ASSERT_EQ(std::sscanf(pixel.c_str(), "pixel %d, %d: %lf at %lf nm", &x, &y, &radiance, &nm), 4)
        << pixel;
    EXPECT_EQ(x, 4);
    EXPECT_EQ(y, 3);
    EXPECT_EQ(nm, 600.0);
    EXPECT_NEAR(radiance, 0.8, 0.05) << "the furnace shows the reflectance of the second cell";
    EXPECT_NEAR(outcome.at("dragged").get<double>(), 580.0, 30.0);
    double from = 0.0, to = 0.0, entry = -1.0;
    const std::string matrix = outcome.at("matrix");
    ASSERT_EQ(std::sscanf(matrix.c_str(), "%lf nm to %lf nm: %lf", &from, &to, &entry), 3)
        << matrix;
    EXPECT_NEAR(entry, from == to ? 0.8 : 0.0, 0.01);
    EXPECT_NE(outcome.at("first_still").get<std::string>().find("pixel"), std::string::npos);
}

TEST_F(PagesInBrowser, ConvergeShowsCurvesAndErrorImages) {
    ASSERT_EQ(run("converge scene.toml -o curves --methods comb,hero:4 --time 0.1").exit_code, 0);
    const nlohmann::json outcome = opened("curves/index.html", R"js(
  outcome.plots = document.querySelectorAll('svg path, svg polyline').length;
  outcome.error_images = document.querySelectorAll('svg image').length;
  outcome.text = document.body.innerText;
)js");
    expect_sound(outcome, 0);
    EXPECT_GE(outcome.at("error_images"), 2);
    EXPECT_GE(outcome.at("plots"), 2);
    EXPECT_NE(outcome.at("text").get<std::string>().find("hero:4"), std::string::npos);
}

// Nothing reaches beyond the page, whose tables scroll where they are too wide.
TEST_F(PagesInBrowser, ColoursFitTheirPage) {
    const std::string spectra = RERADIANT_SOURCE_DIR "/spectra/";
    ASSERT_EQ(run("colour " + spectra + "reradiation/neon-orange.csv " + spectra +
                  "reradiation/neon-yellow.csv --preset neon-orange-varnished --illuminant "
                  "D65,C,A --observer 1931-2,1964-10 --against " +
                  spectra + "reradiation/neon-orange-fitted.csv --polygons " + spectra +
                  "polygons/en-iso-20471.csv --report colours.html --quiet")
                  .exit_code,
              3);
    const nlohmann::json outcome = opened("colours.html", R"js(
  const all = (selector) => [...document.querySelectorAll(selector)];
  outcome.tables = all('table').length;
  outcome.figures = all('figure svg').length;
  outcome.too_wide = document.documentElement.scrollWidth - innerWidth;
  outcome.swatches = all('figure')[0].querySelectorAll('rect > title').length;
  outcome.cut_off = all('figure svg text').filter((text) => {
    const box = text.getBoundingClientRect();
    const page = text.ownerSVGElement.getBoundingClientRect();
    return box.left < page.left - 1 || box.right > page.right + 1 || box.top < page.top - 1 ||
      box.bottom > page.bottom + 1;
  }).map((text) => text.textContent);
)js");
    expect_sound(outcome, 0);
    EXPECT_EQ(outcome.at("tables"), 7);
    EXPECT_EQ(outcome.at("figures"), 2 + 2 + 3);
    EXPECT_LE(outcome.at("too_wide"), 0);
    EXPECT_EQ(outcome.at("swatches"), 3 * 3 * 2);
    EXPECT_EQ(outcome.at("cut_off"), nlohmann::json::array());
}

} // namespace reradiant
