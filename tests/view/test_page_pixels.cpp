// What a page shows, against the models that `measure` asks: spectra, colours, drawn pixels.
#include "host/layers/models/layered_bsdf.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "reradiant/colour.h"
#include "reradiant/measure.h"
#include "tests/view/shown_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

namespace reradiant {

namespace {

/// Readings of the materials that are named in the documents, and of others.
constexpr int pixels = 200, fewer_pixels = 50;

/// The page under one lamp that is a direction, with nothing around: readings at pixels of the lit
/// part of the sphere, drawn from a fixed seed, and what the canvas shows there.
const std::string steps = R"js(
  view.model = MODEL; view.lampRadius = 0; view.around = 0; view.lampAcross = -35; view.lampUp = 30;
  outcome.lamps = [];
  let seed = 20261130;
  const random = () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
  for (const name of LAMPS) {
    view.lamp = lamps.findIndex((lamp) => lamp.name === name);
    isStale = true;
    drawNow();
    const state = states[view.model], readings = [], pixel = new Uint8Array(4);
    while (readings.length < COUNT) {
      const x = Math.floor(SIZE * random()) + 0.5, y = Math.floor(SIZE * random()) + 0.5;
      const found = readingAt(state, x, y);
      if (!found || found.wi[2] < 0.02 || found.wo[2] < 0.02) continue;
      gl.readPixels(x - 0.5, SIZE - y - 0.5, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      readings.push({ wi: found.wi, wo: found.wo, radiance: [...found.radiance], xyz: found.xyz, lab: found.lab,
        rgb: found.rgb.map((value) => 255 * value), drawn: [...pixel].slice(0, 3) });
    }
    outcome.lamps.push({ name, light: [...lampNow()], readings });
  }
  outcome.message = place('message').textContent;
)js";

std::string filled(std::string text, const std::string& name, const std::string& value) {
    const std::size_t at = text.find(name);
    return text.replace(at, name.size(), value);
}

kernels::Vec3 direction(const nlohmann::json& w) {
    return kernels::vec3(w[0].get<double>(), w[1].get<double>(), w[2].get<double>());
}

/// The largest errors of a page under one lamp.
struct PageErrors {
    double radiance = 0.0; ///< relative, or to a thousandth of the reading's largest band
    double ciede2000 = 0.0;
    double drawn = 0.0; ///< between canvas and reading, codes of 8 bits
};

class ExactSurface {
public:
    ExactSurface(const Material& material, Model model)
        : bands_(measured_bands(material, {})),
          surface_(material.stack, measured_substrate(material.substrate, bands_), bands_,
                   closed_model(model)),
          weights_(xyz_weights(bands_)) {}

    void compare(const nlohmann::json& reading, const Eigen::VectorXd& light,
                 PageErrors& errors) const {
        const kernels::Vec3 wi = direction(reading.at("wi"));
        const Eigen::VectorXd exact = surface_.eval(wi, direction(reading.at("wo"))) * light * wi.z;
        const double floor = 1e-3 * exact.maxCoeff();
        for (Eigen::Index band = 0; band < exact.size(); ++band) {
            const double shown = reading.at("radiance")[static_cast<std::size_t>(band)];
            errors.radiance = std::max(errors.radiance, std::fabs(shown - exact(band)) /
                                                            std::max(exact(band), floor));
        }
        for (std::size_t channel = 0; channel < 3; ++channel)
            errors.drawn =
                std::max(errors.drawn, std::fabs(reading.at("rgb")[channel].get<double>() -
                                                 reading.at("drawn")[channel].get<double>()));
        if (!reading.at("lab").is_null())
            errors.ciede2000 = std::max(
                errors.ciede2000,
                ciede2000(lab(exact, light, wi.z), reading.at("lab").get<std::array<double, 3>>()));
    }

private:
    Xyz seen(const Eigen::VectorXd& values) const {
        Xyz sum{};
        for (std::size_t band = 0; band < weights_.size(); ++band)
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += weights_[band][k] * values(static_cast<Eigen::Index>(band));
        return sum;
    }
    std::array<double, 3> lab(const Eigen::VectorXd& exact, const Eigen::VectorXd& light,
                              double cosine) const {
        return xyz_to_lab(seen(exact), seen(light * (cosine * std::numbers::inv_pi)));
    }

    WavelengthGrid bands_;
    LayeredBsdf surface_;
    std::vector<Xyz> weights_;
};

class PagePixels : public ShownPage {
protected:
    PageErrors errors_of(const std::string& preset, Model model, int count = fewer_pixels) const {
        return errors_of(viewed_preset(preset), model, count);
    }
    PageErrors errors_of(const ViewedMaterial& viewed, Model model,
                         int count = fewer_pixels) const {
        std::string asked = filled(steps, "MODEL", fmt::format("'{}'", model_name(model)));
        asked = filled(asked, "LAMPS", "['D65', 'A', 'L:365:10']");
        asked = filled(asked, "COUNT", std::to_string(count));
        const nlohmann::json outcome = opened(page_of(viewed), asked);
        EXPECT_EQ(outcome.value("message", "none"), "");
        const ExactSurface exact(viewed.material, model);
        PageErrors errors;
        for (const nlohmann::json& lamp : outcome.at("lamps")) {
            const auto light = lamp.at("light").get<std::vector<double>>();
            for (const nlohmann::json& reading : lamp.at("readings"))
                exact.compare(reading,
                              Eigen::Map<const Eigen::VectorXd>(
                                  light.data(), static_cast<Eigen::Index>(light.size())),
                              errors);
        }
        fmt::print("{} {}: radiance {:.2e}, CIEDE2000 {:.2e}, drawn {:.2f} codes\n", viewed.name,
                   model_name(model), errors.radiance, errors.ciede2000, errors.drawn);
        return errors;
    }
};

/// Smooth and rough, bare and varnished, fluorescent and not, absorbing in the layer.
const char* const presets[] = {"neon-orange-bare",         "neon-orange-varnished", "red-lacquer",
                               "fluorescent-orange-rough", "fluorescent-pigment",   "glossy-paint"};

} // namespace

// The tables of adding are interpolated over cosine and depth; drawing rounds to 8 bits, half a
// code.
TEST_F(PagePixels, AddingIsThatOfMeasure) {
    for (const char* preset : presets) {
        const PageErrors errors = errors_of(preset, Model::Adding, pixels);
        EXPECT_LT(errors.radiance, 0.01) << preset;
        EXPECT_LT(errors.ciede2000, 1.0) << preset;
        EXPECT_LT(errors.drawn, 1.5) << preset;
    }
}

TEST_F(PagePixels, WeidlichWilkieIsThatOfMeasure) {
    for (const char* preset : presets) {
        const PageErrors errors = errors_of(preset, Model::WeidlichWilkie, pixels);
        EXPECT_LT(errors.radiance, 0.001) << preset;
        EXPECT_LT(errors.ciede2000, 1.0) << preset;
        EXPECT_LT(errors.drawn, 1.5) << preset;
    }
}

// Between Chebyshev's nodes of both cosines; clouds and rough faces too.
TEST_F(PagePixels, DyesInLayersAreThoseOfMeasure) {
    for (const char* preset : {"fluorescent-varnish-on-white", "fluorescent-varnish-on-black",
                               "highlighter-on-paper", "brightened-coating-on-paper"}) {
        const PageErrors errors = errors_of(preset, Model::Adding);
        EXPECT_LT(errors.radiance, 0.01) << preset;
        EXPECT_LT(errors.ciede2000, 1.0) << preset;
        EXPECT_LT(errors.drawn, 1.5) << preset;
    }
}

// Beyond the six: an Oren-Nayar substrate, films, clouds, flakes, metals under coats.
TEST_F(PagePixels, OtherMaterialsAreThoseOfMeasureToo) {
    for (const char* preset : {"house-paint", "sugar", "lepidolite-flake"})
        EXPECT_LT(errors_of(preset, Model::Adding).radiance, 0.01) << preset;
    for (const char* preset : {"metallic-flake-paint", "pearlescent-paint", "patina", "multi-layer",
                               "car-paint", "house-paint"})
        EXPECT_LT(errors_of(preset, Model::WeidlichWilkie).radiance, 0.001) << preset;
}

// Dispersion, every distribution, single scattering, clouds, Oren-Nayar over dyes of the substrate,
// a matrix that no few terms hold.
TEST_F(PagePixels, UnusualMaterialsAreThoseOfMeasure) {
    const std::string dispersive = "ior = { nm = [300, 780], value = [1.58, 1.49] }\n";
    const std::string orange = "reradiation = { file = \"synthetic-orange.csv\" }\n";
    const std::string up = "reradiation = { file = \"up.csv\" }\n";
    const std::string few = "reradiation = { file = \"up-and-down.csv\" }\n";
    const std::string layer = "[material]\n[[material.layer]]\n";
    const std::string lambert = "[material.substrate]\ntype = \"lambert\"\n";
    std::ofstream(folder / "up-and-down.csv")
        << "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
           "# anti-stokes: allowed\nnm,400,450,500,550,600\n400,0.3,0.1,0,0,0\n"
           "450,0.2,0.3,0.05,0,0\n500,0.1,0.2,0.4,0.1,0\n550,0.1,0.1,0.2,0.5,0.1\n"
           "600,0,0.1,0.1,0.2,0.6\n";
    std::ofstream(folder / "up.csv")
        << "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
           "nm,400,450,500,550,600\n400,0.3,0,0,0,0\n450,0.2,0.3,0,0,0\n500,0.1,0.2,0.4,0,0\n"
           "550,0.1,0.1,0.2,0.5,0\n600,0,0.1,0.1,0.2,0.6\n";
    const std::pair<std::string, std::string> materials[] = {
        {"dispersive", layer + dispersive +
                           "alpha = 0.15\ndistribution = \"beckmann\"\nthickness = 0.4\n"
                           "absorption = { nm = [300, 500, 780], value = [2, 0.5, 0.1] }\n"
                           "[[material.layer]]\nior = 1.4\n" +
                           lambert + up},
        {"oren-nayar", layer + "ior = 1.5\nalpha = 0.3\nscattering = \"single\"\n" +
                           "[material.substrate]\ntype = \"oren-nayar\"\nsigma = 0.4\n" + orange},
        {"dense", layer + "ior = 1.5\n" + lambert + few},
        {"clouds", layer + "ior = 1.5\nscattering_coefficient = 0.7\nanisotropy = 0.4\n" + lambert +
                       "reflectance = 0.3\n"},
    };
    for (const auto& [name, text] : materials) {
        std::ofstream(folder / (name + ".toml")) << text;
        const ViewedMaterial viewed{name, load_material(folder / (name + ".toml"))};
        const PageErrors adding = errors_of(viewed, Model::Adding);
        EXPECT_LT(adding.radiance, 0.01) << name;
        EXPECT_LT(adding.drawn, 1.5) << name;
        const PageErrors closed = errors_of(viewed, Model::WeidlichWilkie);
        EXPECT_LT(closed.radiance, 0.001) << name;
        EXPECT_LT(closed.drawn, 1.5) << name;
    }
}

} // namespace reradiant
