// Files for other renderers: what they say, that GLSL compiles and evaluates to the model.
#include "host/layers/models/layered_bsdf.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "host/view/export/exchange_files.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"
#include "reradiant/measure.h"
#include "tests/view/shown_page.h"

#include <fmt/format.h>

#include <cmath>

namespace reradiant {

namespace {

const Lamp daylight = lamp_from_text("D65");

/// A page that compiles the functions and draws their values for several pairs of directions.
std::string glsl_page(const std::string& functions) {
    return "<html><head></head><body><script type=\"text/plain\" id=\"functions\">" + functions +
           "</script></body></html>";
}

/// Values come as floats: nine pairs of directions, a pixel each.
const std::string evaluate = R"js(
  const gl = document.createElement('canvas').getContext('webgl2');
  gl.getExtension('EXT_color_buffer_float');
  const head = '#version 300 es\nprecision highp float;\nprecision highp int;\n';
  const shader = (type, source) => { const made = gl.createShader(type); gl.shaderSource(made, head + source);
    gl.compileShader(made); if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made)); return made; };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, 'in vec2 p; void main() { gl_Position = vec4(p, 0, 1); }'));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, document.getElementById('functions').textContent + `
out vec4 colour;
void main() {
    float i = floor(gl_FragCoord.x) * 0.4 + 0.1, o = floor(gl_FragCoord.y) * 0.4 + 0.2;
    colour = vec4(rr_eval(vec3(sin(i), 0.0, cos(i)), vec3(-sin(o) * cos(0.7), sin(o) * sin(0.7), cos(o))), 1.0);
}`));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const target = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, target);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 3, 3);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, 3, 3);
  gl.useProgram(program);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const values = new Float32Array(36);
  gl.readPixels(0, 0, 3, 3, gl.RGBA, gl.FLOAT, values);
  outcome.values = [...values];
)js";

std::array<double, 3> exact_colour(const Material& material, Model model, double i, double o) {
    const WavelengthGrid bands = measured_bands(material, {});
    const LayeredBsdf surface(material.stack, measured_substrate(material.substrate, bands), bands,
                              closed_model(model));
    const std::vector<Xyz> weights = xyz_weights(bands);
    Eigen::VectorXd light(bands.count);
    double y = 0.0;
    for (int band = 0; band < bands.count; ++band) {
        light(band) = daylight.light.average(bands.lower_edge_nm(band), bands.upper_edge_nm(band));
        y += light(band) * weights[static_cast<std::size_t>(band)][1];
    }
    const Eigen::VectorXd sent =
        surface.eval(
            kernels::vec3(std::sin(i), 0.0, std::cos(i)),
            kernels::vec3(-std::sin(o) * std::cos(0.7), std::sin(o) * std::sin(0.7), std::cos(o))) *
        light * (std::cos(i) / y);
    Xyz xyz{};
    for (int band = 0; band < bands.count; ++band)
        for (std::size_t k = 0; k < 3; ++k)
            xyz[k] += weights[static_cast<std::size_t>(band)][k] * sent(band);
    return xyz_to_linear_srgb(xyz);
}

using GlslFile = ShownPage;

LampColours colours_of(const std::string& preset) {
    return lamp_colours(viewed_preset(preset), daylight);
}
bool holds(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

} // namespace

// Tables have fewer nodes than the page's, and light of several facets the directions of the
// residual.
TEST_F(GlslFile, EvaluatesToTheModelInTheBrowser) {
    for (const auto& [preset, model] : {std::pair{"neon-orange-varnished", Model::Adding},
                                        {"fluorescent-orange-rough", Model::Adding},
                                        {"glossy-paint", Model::Adding},
                                        {"car-paint", Model::WeidlichWilkie},
                                        {"pearlescent-paint", Model::WeidlichWilkie}}) {
        const ViewedMaterial viewed = viewed_preset(preset);
        const nlohmann::json outcome = opened(glsl_page(glsl_file(viewed, daylight)), evaluate);
        ASSERT_TRUE(outcome.contains("values")) << preset;
        for (std::size_t pixel = 0; pixel < 9; ++pixel) {
            const std::array<double, 3> exact =
                exact_colour(viewed.material, model, 0.4 * static_cast<double>(pixel % 3) + 0.1,
                             0.4 * std::floor(static_cast<double>(pixel) / 3.0) + 0.2);
            const double largest = std::max({exact[0], exact[1], exact[2]});
            for (std::size_t channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(outcome.at("values")[4 * pixel + channel].get<double>(), exact[channel],
                            0.01 * largest)
                    << preset << " pixel " << pixel;
        }
    }
}

TEST(ExchangeFiles, HeadsSayTheLampAndWhatIsLeftOut) {
    const LampColours colours = colours_of("fluorescent-orange-rough");
    for (const std::string& text :
         {osl_file(colours), materialx_file(colours), mitsuba_file(colours),
          glsl_file(viewed_preset("fluorescent-orange-rough"), daylight)}) {
        EXPECT_TRUE(holds(text, "fluorescent-orange-rough under D65"));
        EXPECT_TRUE(holds(text, "Left out:"));
    }
    EXPECT_TRUE(holds(osl_file(colours), "Re-radiation is in the colours"));
}

// An orange that sends out more than it gets has a colour above 1, which reflectances cannot hold.
TEST(ExchangeFiles, ColoursAboveOneAreClippedWithAWord) {
    const LampColours colours = colours_of("fluorescent-orange-bare");
    EXPECT_GT(colours.substrate[0], 1.0);
    for (const std::string& text : {materialx_file(colours), mitsuba_file(colours)})
        EXPECT_TRUE(holds(text, "was clipped to 0 to 1"));
    std::vector<std::string> notes;
    EXPECT_EQ(clipped({0.5, 0.0, 1.0}, "A colour", notes), (LampColours::Rgb{0.5, 0.0, 1.0}));
    EXPECT_TRUE(notes.empty());
}

TEST(ExchangeFiles, MetalsAndCoatsFindTheirPlace) {
    const LampColours paint = colours_of("car-paint"), lacquer = colours_of("red-lacquer");
    EXPECT_TRUE(holds(materialx_file(paint), "base_metalness\" type=\"float\" value=\"1\""));
    EXPECT_TRUE(holds(materialx_file(paint), "coat_weight"));
    EXPECT_FALSE(holds(materialx_file(lacquer), "coat_weight"));
    EXPECT_TRUE(holds(materialx_file(lacquer), "specular_ior\" type=\"float\" value=\"1.5\""));
    EXPECT_TRUE(holds(mitsuba_file(paint), "type=\"principled\""));
    EXPECT_TRUE(holds(mitsuba_file(lacquer), "type=\"roughplastic\""));
    EXPECT_TRUE(holds(mitsuba_file(colours_of("neon-orange-varnished")), "type=\"plastic\""));
    EXPECT_TRUE(holds(mitsuba_file(colours_of("neon-orange-bare")), "type=\"diffuse\""));
    EXPECT_TRUE(holds(osl_file(colours_of("house-paint")), "oren_nayar"));
}

TEST(ExchangeFiles, NamesAreMadeFitForEveryLanguage) {
    ViewedMaterial viewed = viewed_preset("neon-orange-bare");
    viewed.name = "4 x <--> \n\"rot\"";
    const LampColours colours = lamp_colours(viewed, daylight);
    for (const std::string& text :
         {osl_file(colours), materialx_file(colours), mitsuba_file(colours)})
        EXPECT_TRUE(holds(text, "material_4_x________rot_"));
    const std::string xml = materialx_file(colours);
    const std::size_t end = xml.find("-->");
    EXPECT_EQ(xml.find("--", xml.find("<!--") + 4), end)
        << "nothing ends the comment before its end";
}

TEST(ExchangeFiles, LampsWithoutAWhiteAreRefused) {
    EXPECT_THROW(lamp_colours(viewed_preset("red-lacquer"), lamp_from_text("L:700:2")), Error);
}

} // namespace reradiant
