// Pages of pictures whose lights slide: what they hold, and what they show, against the file.
#include "host/film/display/develop.h"
#include "host/film/lamp_cells.h"
#include "host/view/lights/layer_code.h"
#include "host/view/lights/lights_page.h"
#include "reradiant/colour.h"
#include "reradiant/spectral_files.h"
#include "tests/view/shown_page.h"

#include <cmath>
#include <random>

namespace reradiant {

namespace {

const WavelengthGrid film{340.0, 20.0, 23};
constexpr int width = 24, height = 18;

/// A picture lit by daylight, whose two parts are noisy mixtures of three bodies, and by a lamp at
/// 370 nm that makes one of them shine. Brightness spans four decades.
struct LitPicture {
    SpectralImage image;
    std::vector<LightLayer> layers;
};

std::vector<float> mixed(std::mt19937& random, const std::vector<Spectrum>& bodies,
                         const Spectrum& lamp) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<float> values;
    for (int pixel = 0; pixel < width * height; ++pixel) {
        const double level = pixel == 7 ? 0.0 : std::pow(10.0, -3.0 * share(random));
        std::vector<double> shares;
        for (std::size_t k = 0; k < bodies.size(); ++k)
            shares.push_back(share(random));
        for (const double nm : film.centres_nm()) {
            double value = 0.0;
            for (std::size_t k = 0; k < bodies.size(); ++k)
                value += shares[k] * bodies[k](nm);
            values.push_back(static_cast<float>(level * value * lamp(nm)));
        }
    }
    return values;
}

LitPicture lit_picture() {
    std::mt19937 random(5);
    const Spectrum day = illuminant_with_luminance("D65", 1.0), one = Spectrum::constant(1.0);
    const std::vector<Spectrum> bodies = {Spectrum::constant(0.8),
                                          Spectrum::table({380, 700}, {0.1, 0.7}),
                                          Spectrum::gaussian(480, 60, 0.6)};
    const Spectrum below = Spectrum::table({395, 396}, {1.0, 0.0}),
                   above = Spectrum::table({395, 396}, {0.0, 1.0});
    const auto times = [](std::vector<Spectrum> of, const Spectrum& mask) {
        for (Spectrum& spectrum : of) {
            std::vector<double> nm, value;
            for (double at = 330; at <= 800; at += 1.0) {
                nm.push_back(at);
                value.push_back(spectrum(at) * mask(at));
            }
            spectrum = Spectrum::table(nm, value);
        }
        return of;
    };
    LitPicture picture;
    picture.image.width = width;
    picture.image.height = height;
    picture.image.bands = film;
    std::vector<Spectrum> uv = times(bodies, below);
    uv.push_back(Spectrum::gaussian(540, 25, 0.4));
    picture.layers = {
        {"day", LightPart::Ultraviolet, 330, 390, lamp_cell_means(day), mixed(random, uv, one)},
        {"day", LightPart::Visible, 390, 790, lamp_cell_means(day),
         mixed(random, times(bodies, above), day)},
        {"lamp", LightPart::Whole, 330, 790, lamp_cell_means(one), mixed(random, bodies, one)}};
    picture.image.values.assign(picture.layers[0].values.size(), 0.0f);
    for (const LightLayer& layer : picture.layers)
        for (std::size_t i = 0; i < layer.values.size(); ++i)
            picture.image.values[i] += layer.values[i];
    return picture;
}

class LightsPageShown : public ShownPage {
protected:
    std::filesystem::path written(const LitPicture& picture) const {
        const std::filesystem::path file = folder / "picture.exr";
        write_spectral_exr(file, picture.image, 0.0, picture.layers);
        return file;
    }
};

const std::string reads = R"js(
  await ready;
  const slide = (id, value) => { const input = place(id); input.value = value; input.dispatchEvent(new Event('input')); };
  const choose = (id, value) => { const input = place(id); input.value = value; input.dispatchEvent(new Event('change')); };
  const drawn = () => { drawNow(); return [...pen.getImageData(0, 0, data.width, data.height).data].filter((_, i) => i % 4 < 3); };
)js";

std::vector<double> radiance_of(const LightLayer& layer, std::size_t pixel) {
    const auto bands = static_cast<std::size_t>(film.count);
    return {layer.values.begin() + static_cast<std::ptrdiff_t>(pixel * bands),
            layer.values.begin() + static_cast<std::ptrdiff_t>((pixel + 1) * bands)};
}

/// Means of a lamp over the film's bands at the level that lamps are compared at: Y, or for a lamp
/// that is hardly seen its mean over 480 nm.
std::vector<double> levelled(const Spectrum& lamp, double& level) {
    std::vector<double> means;
    double y = 0.0, energy = 0.0;
    const auto weights = xyz_weights(film);
    for (int b = 0; b < film.count; ++b) {
        means.push_back(lamp.average(film.lower_edge_nm(b), film.upper_edge_nm(b)));
        y += means.back() * weights[static_cast<std::size_t>(b)][1];
        energy += means.back() * film.step_nm / 480.0;
    }
    level = std::max(y, 0.5 * energy);
    for (double& mean : means)
        mean /= level;
    return means;
}

} // namespace

// What the steps of lengths and directions and the basis' tolerance leave: 1e-3 of the basis, 2e-3
// / sqrt(12) of each of at most five numbers.
TEST(LayerCodes, HoldSpectraToTheErrorThatTheySay) {
    const LitPicture picture = lit_picture();
    for (const LightLayer& layer : picture.layers) {
        const std::vector<LayerCode> codes = layer_codes(layer.values, film);
        EXPECT_EQ(codes.size(), layer.part == LightPart::Visible ? 1u : 2u);
        for (const LayerCode& code : codes) {
            EXPECT_LE(code.rank, 4);
            EXPECT_LT(code.rms_error, 2e-3);
            EXPECT_LT(code.worst_error, 1e-2);
            double worst = 0.0;
            for (std::size_t p = 0; p < std::size_t{width * height}; ++p) {
                const std::vector<double> truth = radiance_of(layer, p), coded = code.spectrum(p);
                double off = 0.0, length = 0.0;
                for (std::size_t b = 0; b < coded.size(); ++b) {
                    const double value = truth[b + static_cast<std::size_t>(code.first_band)];
                    off += (coded[b] - value) * (coded[b] - value);
                    length += value * value;
                }
                worst = std::max(worst, length > 0.0 ? std::sqrt(off / length) : off);
            }
            EXPECT_NEAR(worst, code.worst_error, 1e-6);
        }
    }
}

TEST_F(LightsPageShown, SlidersGiveThePictureThatDevelopGives) {
    const LitPicture picture = lit_picture();
    const std::filesystem::path file = written(picture);
    const nlohmann::json outcome = opened(lights_page({file, {}}), reads + R"js(
  slide('exposure', 0);
  outcome.all = drawn();
  slide('gain-0', 0); slide('gain-1', 0.3); slide('gain-2', 1.5);
  outcome.turned = drawn();
  outcome.command = place('command').textContent;
)js");
    for (const auto& [name, factors] :
         {std::pair{"all", LightFactors{}},
          {"turned", LightFactors{{"day.uv", 0.0}, {"day.visible", 0.3}, {"lamp", 8.0}}}}) {
        const std::vector<std::uint8_t> expected =
            develop(factors.empty() ? read_spectral_exr(file) : read_relit_image(file, factors), {})
                .rgb;
        const auto shown = outcome.at(name).get<std::vector<int>>();
        ASSERT_EQ(shown.size(), expected.size());
        for (std::size_t i = 0; i < shown.size(); ++i)
            ASSERT_LE(std::abs(shown[i] - expected[i]), 1) << name << ", channel " << i;
    }
    EXPECT_NE(
        outcome.at("command").get<std::string>().find("--groups day.uv=0,day.visible=0.3,lamp=8"),
        std::string::npos)
        << outcome.at("command");
}

TEST_F(LightsPageShown, AnotherLampTakesThePlaceOfAGroups) {
    const LitPicture picture = lit_picture();
    const nlohmann::json outcome =
        opened(lights_page({written(picture), {lamp_from_text("A")}}), reads + R"js(
  choose('lamp-day', 0); choose('lamp-lamp', 0); slide('gain-0', 1);
  outcome.parts = readingAt(5, 3).parts.map((part) => [...part]);
  outcome.before = place('message').textContent;
  choose('lamp-day', -1); choose('lamp-lamp', lamps.findIndex((lamp) => lamp.name === 'L:365:10'));
  outcome.line = readingAt(5, 3).parts.map((part) => [...part]);
)js");
    const Spectrum lamps[] = {illuminant_with_luminance("D65", 1.0), Spectrum::constant(1.0),
                              lamp_from_text("A").light};
    double day_level = 0.0, one_level = 0.0, a_level = 0.0;
    const std::vector<double> day = levelled(lamps[0], day_level),
                              one = levelled(lamps[1], one_level), a = levelled(lamps[2], a_level);
    double power_a = 0.0, power_day = 0.0;
    for (int nm = 330; nm < 390; ++nm) {
        power_a += lamps[2].average(nm - 0.5, nm + 0.5) / a_level;
        power_day += lamps[0].average(nm - 0.5, nm + 0.5) / day_level;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const LightLayer& layer = picture.layers[k];
        const std::vector<double> own = radiance_of(layer, 3 * width + 5);
        const double largest = *std::max_element(own.begin(), own.end());
        for (std::size_t b = 0; b < own.size(); ++b) {
            const double nm = film.centre_nm(static_cast<int>(b));
            const bool is_inside = nm >= layer.from_nm && nm < layer.to_nm;
            const double factor = !is_inside ? power_a / power_day
                                  : k == 2   ? a[b] / one[b]
                                             : a[b] / day[b];
            EXPECT_NEAR(outcome.at("parts")[k][b].get<double>(), factor * own[b],
                        5e-3 * factor * largest)
                << layer.name() << " at " << nm;
        }
    }
    EXPECT_EQ(outcome.at("before"), "") << "A shines where these lights do";
    const std::vector<double> before = radiance_of(picture.layers[1], 3 * width + 5);
    EXPECT_NEAR(outcome.at("line")[1][10].get<double>(), before[10], 5e-3 * before[10]);
    EXPECT_EQ(outcome.at("line")[2][10].get<double>(), 0.0) << "540 nm is dark under a line at 365";
}

TEST_F(LightsPageShown, SaysWhatALampLacksAndWhatCannotBeChanged) {
    LitPicture picture = lit_picture();
    picture.layers[2].lamp = lamp_cell_means(Spectrum::line(370, 10, 1.0));
    picture.layers[0].lamp.clear();
    picture.layers[1].lamp.clear();
    const nlohmann::json outcome = opened(lights_page({written(picture), {}}), reads + R"js(
  choose('lamp-lamp', 0);
  outcome.lacks = place('message').textContent;
  outcome.noChoice = place('lamp-day') === null && place('groups').textContent.includes('differ in their spectra');
  outcome.told = place('told').textContent;
  let key = (k, shiftKey) => canvas.dispatchEvent(new KeyboardEvent('keydown', { key: k, shiftKey, cancelable: true }));
  const before = view.x; key('ArrowRight'); key('ArrowRight', true);
  outcome.moved = view.x - before;
  outcome.unlabelled = [...document.querySelectorAll('input,select,textarea')].filter((input) => !input.closest('label')).length;
  outcome.lab = place('reading').textContent;
)js");
    EXPECT_NE(outcome.at("lacks").get<std::string>().find("is missing"), std::string::npos);
    EXPECT_TRUE(outcome.at("noChoice").get<bool>());
    EXPECT_NE(outcome.at("told").get<std::string>().find("root mean square"), std::string::npos);
    EXPECT_EQ(outcome.at("moved"), 9);
    EXPECT_EQ(outcome.at("unlabelled"), 0);
    EXPECT_NE(outcome.at("lab").get<std::string>().find("L*, a*, b*"), std::string::npos);
}

TEST_F(LightsPageShown, PictureWithoutGroupsHasOneSlider) {
    LitPicture picture = lit_picture();
    picture.layers.clear();
    const nlohmann::json outcome = opened(lights_page({written(picture), {}}), reads + R"js(
  outcome.sliders = document.querySelectorAll('#groups input').length;
  outcome.radiance = [...readingAt(5, 3).radiance];
)js");
    EXPECT_EQ(outcome.at("sliders"), 1);
    for (int b = 0; b < film.count; ++b)
        EXPECT_NEAR(outcome.at("radiance")[static_cast<std::size_t>(b)].get<double>(),
                    static_cast<double>(picture.image.at(5, 3, b)), 1e-2);
}

TEST_F(LightsPageShown, LargePicturesAreShownByMeansAndSaySo) {
    SpectralImage image;
    image.width = 1400;
    image.height = 1200;
    image.bands = {500.0, 100.0, 1};
    for (int i = 0; i < image.width * image.height; ++i)
        image.values.push_back(i % 2 == 0 ? 1.0f : 3.0f);
    const std::filesystem::path file = folder / "large.exr";
    write_spectral_exr(file, image);
    const nlohmann::json outcome = opened(lights_page({file, {}}), reads + R"js(
  outcome.size = [canvas.width, canvas.height];
  outcome.radiance = [...readingAt(5, 3).radiance];
  outcome.told = place('told').textContent;
)js");
    EXPECT_EQ(outcome.at("size"), (std::vector<int>{700, 600}));
    EXPECT_NEAR(outcome.at("radiance")[0].get<double>(), 2.0, 4e-3);
    EXPECT_NE(outcome.at("told").get<std::string>().find("means of 2 x 2"), std::string::npos);
}

} // namespace reradiant
