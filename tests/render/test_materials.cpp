// Every kind of material: what the renderer shows of it is what `measure` says of it.
#include "host/layers/models/layered_bsdf.h"
#include "host/measure/measure_substrate.h"
#include "host/scene/model/closed_model.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"
#include "tests/render/test_scenes.h"
#include "tests/support/directions.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

namespace reradiant {
namespace {

using namespace test;

const WavelengthGrid bands = grid_from_range(450, 650, 50);

/// View, incidence and azimuth between them, degrees: across, and near the mirror's direction.
struct Geometry {
    double view, incidence, phi;
};
constexpr Geometry geometries[] = {{40, 30, 90}, {50, 35, 170}};
/// A sheet may be seen from below and lit from there.
constexpr Geometry geometries_of_sheets[] = {{40, 30, 90},   {50, 35, 170},  {40, 150, 90},
                                             {50, 135, 170}, {140, 150, 90}, {130, 35, 170}};

LayeredBsdf bsdf_of(const Material& m, Model model, const WavelengthGrid& grid) {
    return {m.stack, measured_substrate(m.substrate, grid), grid, closed_model(model)};
}

RenderResult render_plane(const Material& m, Model model, const WavelengthGrid& grid,
                          const Geometry& at) {
    Scene scene = plane_scene(m, at.view, 8, 8);
    scene.lights = {directional(at.incidence, at.phi, Spectrum::constant(1.0))};
    scene.integrator.max_depth = 1;
    RenderOptions options;
    options.bands = grid;
    options.samples = 2;
    options.model = model;
    options.wavelengths.centred = true;
    options.all_features = true; // one program for all: what is left out is tested below
    return render(scene, device(), options);
}

/// A directional light leaves nothing to chance: the radiance is f cos. `tolerance` (relative):
/// single precision along the path and in tables, 0.005 degrees of view over the film, which a lobe
/// of alpha 0.2 turns into 1e-4 on its flank.
void expect_as_measured(const char* what, const Material& m, Model model,
                        const WavelengthGrid& grid = bands, double tolerance = 3e-4) {
    const LayeredBsdf bsdf = bsdf_of(m, model, grid);
    const auto all = m.stack.is_sheet() ? std::span<const Geometry>(geometries_of_sheets)
                                        : std::span<const Geometry>(geometries);
    for (const Geometry& at : all) {
        const auto direction = [](double theta, double phi) {
            const double s = std::sin(radians(theta));
            return kernels::vec3(s * std::cos(radians(phi)), s * std::sin(radians(phi)),
                                 std::cos(radians(theta)));
        };
        const kernels::Vec3 wi = direction(at.incidence, at.phi), wo = direction(at.view, 0.0);
        const RenderResult result = render_plane(m, model, grid, at);
        EXPECT_EQ(result.non_finite, 0u) << what;
        const Eigen::MatrixXd values = bsdf.eval(wi, wo);
        for (int band = 0; band < grid.count; ++band) {
            const double expected =
                values.row(band).sum() * std::fabs(std::cos(radians(at.incidence)));
            EXPECT_NEAR(band_statistics(result.image, band).mean, expected, tolerance * expected)
                << what << ", " << model_name(model) << ", band " << band << ", view " << at.view
                << ", incidence " << at.incidence << ", phi " << at.phi;
        }
    }
}

Spectrum ramp(double from, double to) {
    return Spectrum::table({400, 700}, {from, to});
}

Material oren_nayar(std::vector<Layer> layers, double sigma, double reflectance = 0.7) {
    Material m = material(std::move(layers), reflectance);
    m.substrate.type = SubstrateType::OrenNayar;
    m.substrate.sigma = sigma;
    return m;
}

/// Something like gold.
Conductor metal(double alpha, Distribution distribution = Distribution::Ggx) {
    Conductor conductor;
    conductor.ior = ramp(1.6, 0.15);
    conductor.kappa = ramp(1.9, 3.5);
    conductor.alpha = alpha;
    conductor.distribution = distribution;
    return conductor;
}

Material on_metal(std::vector<Layer> layers, const Conductor& conductor) {
    Material m = material(std::move(layers), 0.0);
    m.substrate.type = SubstrateType::Conductor;
    m.substrate.conductor = conductor;
    return m;
}

/// A lacquer that absorbs.
Layer lacquer(double alpha) {
    Layer top = layer(1.5, alpha);
    top.absorption = ramp(0.8, 0.05);
    return top;
}

Layer scattering(double ior, double alpha, double anisotropy) {
    Layer slab = layer(ior, alpha, 0.1);
    slab.scattering_coefficient = ramp(0.4, 1.5);
    slab.anisotropy = anisotropy;
    return slab;
}

Layer with_flakes(Layer slab, double coverage, const Conductor& reflector) {
    slab.flakes = Flakes{coverage, reflector};
    return slab;
}

TEST(Materials, OrenNayarUnderAddingIsAsMeasured) {
    for (const double sigma : {0.2, 0.6})
        expect_as_measured("bare", oren_nayar({}, sigma), Model::Adding);
    expect_as_measured("smooth", oren_nayar({layer(1.5)}, 0.5), Model::Adding);
    expect_as_measured("lacquer", oren_nayar({lacquer(0.0), layer(1.3)}, 0.5), Model::Adding);
    expect_as_measured("rough", oren_nayar({layer(1.5, 0.3)}, 0.5), Model::Adding);
}

TEST(Materials, FluorescentOrenNayarUnderAddingIsAsMeasured) {
    const ReradiationMatrix matrix = shifted_matrix();
    for (const auto& layers : {std::vector<Layer>{}, {lacquer(0.0)}}) {
        Material m = fluorescent(layers, matrix);
        m.substrate.type = SubstrateType::OrenNayar;
        m.substrate.sigma = 0.5;
        expect_as_measured("fluorescent", m, Model::Adding, matrix.emission);
    }
}

TEST(Materials, OrenNayarUnderWeidlichWilkieIsAsMeasured) {
    expect_as_measured("bare", oren_nayar({}, 0.5), Model::WeidlichWilkie);
    expect_as_measured("smooth", oren_nayar({lacquer(0.0)}, 0.5), Model::WeidlichWilkie);
    expect_as_measured("rough", oren_nayar({lacquer(0.3)}, 0.5), Model::WeidlichWilkie);
}

TEST(Materials, ConductorsAreAsMeasured) {
    for (const Distribution distribution :
         {Distribution::Ggx, Distribution::Beckmann, Distribution::Blinn})
        expect_as_measured("bare", on_metal({}, metal(0.25, distribution)), Model::WeidlichWilkie);
    expect_as_measured("under lacquer", on_metal({lacquer(0.0)}, metal(0.25)),
                       Model::WeidlichWilkie);
    expect_as_measured("under rough lacquer", on_metal({lacquer(0.2)}, metal(0.25)),
                       Model::WeidlichWilkie);
    Conductor single = metal(0.25);
    single.scattering = Scattering::Single;
    expect_as_measured("single", on_metal({}, single), Model::WeidlichWilkie);
}

TEST(Materials, FilmsAreAsMeasured) {
    // Tables of a reflectance over its facets are cubic: 4e-5 of it for films of a few hundred nm.
    Conductor coated = metal(0.25);
    coated.film = ThinFilm{180.0, Spectrum::constant(2.2)};
    expect_as_measured("on a metal", on_metal({}, coated), Model::WeidlichWilkie);
    for (const double alpha : {0.0, 0.25}) {
        Layer top = lacquer(alpha);
        top.film = ThinFilm{250.0, Spectrum::constant(1.8)};
        expect_as_measured("on a layer", material({top}, 0.5), Model::WeidlichWilkie);
        expect_as_measured("on a layer over a metal", on_metal({top}, metal(0.25)),
                           Model::WeidlichWilkie);
    }
}

TEST(Materials, FlakesAreAsMeasured) {
    Conductor pearl = metal(0.2);
    pearl.film = ThinFilm{120.0, Spectrum::constant(2.4)};
    const Layer paint = with_flakes(lacquer(0.0), 0.3, pearl);
    expect_as_measured("one sheet", material({paint}, 0.2), Model::WeidlichWilkie);
    expect_as_measured("two sheets under a rough top",
                       material({with_flakes(lacquer(0.25), 0.3, metal(0.2)), paint}, 0.2),
                       Model::WeidlichWilkie);
    expect_as_measured("smooth flakes",
                       on_metal({with_flakes(lacquer(0.25), 0.5, metal(0.0))}, metal(0.3)),
                       Model::WeidlichWilkie);
}

TEST(Materials, ScatteringSlabsAreAsMeasured) {
    for (const Model model : {Model::Adding, Model::WeidlichWilkie}) {
        expect_as_measured("smooth", material({scattering(1.5, 0.0, 0.5)}, 0.4), model);
        expect_as_measured("two", material({lacquer(0.0), scattering(1.3, 0.3, -0.3)}, 0.4), model);
    }
    expect_as_measured("over a metal", on_metal({scattering(1.5, 0.0, 0.7)}, metal(0.25)),
                       Model::WeidlichWilkie);
    for (const double alpha : {0.0, 0.25}) {
        Layer filmed = scattering(1.5, alpha, 0.5);
        filmed.film = ThinFilm{250.0, Spectrum::constant(1.8)};
        expect_as_measured("beneath a film", material({filmed}, 0.4), Model::WeidlichWilkie);
    }
}

/// A dye that absorbs from 430 to 560 nm, within the bands, and emits from 480 nm on.
SlabDye dye() {
    SlabDye result;
    result.absorption = Spectrum::table({430, 450, 500, 560}, {0.0, 2.0, 1.2, 0.0});
    result.emission = Spectrum::table({480, 560, 640, 700}, {0.0, 1.0, 0.4, 0.0});
    result.quantum_yield = 0.9;
    return result;
}

Layer dyed(Layer layer) {
    layer.dyes = {dye()};
    return layer;
}

/// A dye that lies in the light of another one.
Layer dyed_red(Layer layer) {
    layer.dyes = {dye()};
    layer.dyes.front().absorption = Spectrum::table({480, 550, 620}, {0.0, 1.5, 0.0});
    layer.dyes.front().emission = Spectrum::table({560, 620, 700}, {0.0, 1.0, 0.2});
    return layer;
}

TEST(Materials, DyesInLayersAreAsMeasured) {
    const double channels = 2e-3; // of what few functions of the direction leave out
    expect_as_measured("smooth", material({dyed(lacquer(0.0))}, 0.6), Model::Adding, bands,
                       channels);
    expect_as_measured("rough", material({dyed(lacquer(0.25))}, 0.6), Model::Adding, bands,
                       channels);
    expect_as_measured("scattering", material({dyed(scattering(1.5, 0.0, 0.4))}, 0.3),
                       Model::Adding, bands, channels);
    expect_as_measured("cascade", material({dyed(lacquer(0.0)), dyed_red(layer(1.4))}, 0.3),
                       Model::Adding, bands, channels);
    const ReradiationMatrix matrix = shifted_matrix();
    expect_as_measured("over a fluorescent substrate", fluorescent({dyed(lacquer(0.0))}, matrix),
                       Model::Adding, matrix.emission, channels);
}

Material sheet(std::vector<Layer> layers, double alpha_below) {
    Material m = material(std::move(layers), 0.0);
    m.substrate.type = SubstrateType::None;
    m.stack.lower_face = LowerFace{.alpha = alpha_below};
    return m;
}

TEST(Materials, SheetsAreAsMeasuredOnBothSides) {
    const double channels = 2e-3;
    // kernels read amplitudes linearly, and those of tabulated lobes are less smooth
    const double ratios = 6e-4;
    expect_as_measured("scattering", sheet({scattering(1.5, 0.0, 0.4)}, 0.0), Model::Adding);
    expect_as_measured("rough", sheet({layer(1.5, 0.25)}, 0.2), Model::Adding, bands, ratios);
    expect_as_measured("rough below", sheet({lacquer(0.0)}, 0.25), Model::Adding);
    expect_as_measured("dyed", sheet({dyed(lacquer(0.0))}, 0.0), Model::Adding, bands, channels);
    expect_as_measured("dyed, scattering", sheet({dyed(scattering(1.4, 0.0, 0.6))}, 0.0),
                       Model::Adding, bands, channels);
    expect_as_measured("two slabs", sheet({dyed(lacquer(0.0)), dyed_red(layer(1.3))}, 0.0),
                       Model::Adding, bands, channels);
}

TEST(Materials, DispersiveWeidlichWilkieIsAsMeasured) {
    Layer top = with_flakes(scattering(1.5, 0.2, 0.4), 0.3, metal(0.25));
    top.ior = ramp(1.7, 1.4);
    expect_as_measured("everything", on_metal({top, layer(1.8, 0.3)}, metal(0.3)),
                       Model::WeidlichWilkie);
}

TEST(Materials, SmoothMetalsMirrorTheirSurroundings) {
    Conductor coated = metal(0.0);
    coated.film = ThinFilm{150.0, Spectrum::constant(1.6)};
    for (const Material& m : {on_metal({}, metal(0.0)), on_metal({lacquer(0.0)}, coated)}) {
        Scene scene = plane_scene(m, 50.0, 8, 8);
        scene.lights = {environment(Spectrum::constant(1.0))};
        RenderOptions options;
        options.bands = bands;
        options.samples = 512;
        options.wavelengths.centred = true;
        options.all_features = true;
        const RenderResult result = render(scene, device(), options);
        const LayeredBsdf bsdf = bsdf_of(m, Model::WeidlichWilkie, bands);
        for (int band = 0; band < bands.count; ++band) {
            const double c = std::cos(radians(50.0));
            const double front = bsdf.at(band).specular_delta(c),
                         metal_once = bsdf.at(band).conductor_delta(c);
            // weidlich-wilkie sees the metal once; between it and the coat light goes to and fro.
            const double again = front * metal_once / ((1.0 - front) * (1.0 - front));
            const double expected = front + metal_once / (1.0 - again);
            const BandStatistics found = band_statistics(result.image, band);
            EXPECT_NEAR(found.mean, expected,
                        test::sidak_bound(2 * bands.count) * found.standard_error + 1e-4 * expected)
                << band;
        }
    }
}

/// Light of all bands that leaves in each.
Eigen::VectorXd sum_of(const LayeredBsdf::Parts& parts) {
    return (parts.diffuse + parts.slab).rowwise().sum() + parts.specular;
}

/// Radiance in a furnace of radiance 1 is the directional-hemispherical reflectance, as adding is
/// reciprocal. It takes in how directions are sampled and weighted.
void expect_furnace_as_measured(const char* what, const Material& m, double view) {
    Scene scene = plane_scene(m, view, 12, 12);
    scene.lights = {environment(Spectrum::constant(1.0))};
    RenderOptions options;
    options.bands = bands;
    options.samples = 256;
    options.wavelengths.centred = true;
    options.all_features = true;
    const RenderResult result = render(scene, device(), options);
    const LayeredBsdf bsdf = bsdf_of(m, Model::Adding, bands);
    const AirDirection from{std::fabs(std::cos(radians(view))),
                            view < 90.0 ? Side::Above : Side::Below};
    // light that comes from a side and leaves towards the view goes as well from there to the side
    Eigen::VectorXd leaving = sum_of(bsdf.albedo(from, from.side));
    if (bsdf.is_sheet())
        leaving += sum_of(bsdf.albedo(from, opposite(from.side)));
    for (int band = 0; band < bands.count; ++band) {
        const double expected = leaving(band);
        const BandStatistics found = band_statistics(result.image, band);
        // 1e-3: the angular tables of rough stacks, as in the white furnace
        EXPECT_NEAR(found.mean, expected,
                    test::sidak_bound(6 * bands.count) * found.standard_error + 1e-3 * expected)
            << what << ", view " << view << ", band " << band;
    }
}

TEST(Materials, FurnacesOfOrenNayarAndScatteringSlabsAreAsMeasured) {
    for (const double view : {20.0, 70.0}) {
        expect_furnace_as_measured("oren-nayar", oren_nayar({}, 0.5), view);
        expect_furnace_as_measured("oren-nayar, rough", oren_nayar({layer(1.5, 0.3)}, 0.5), view);
        expect_furnace_as_measured("slab", material({scattering(1.5, 0.0, 0.5)}, 0.4), view);
    }
}

TEST(Materials, FurnacesOfSheetsAreAsMeasured) {
    for (const double view : {20.0, 70.0, 160.0}) {
        expect_furnace_as_measured("smooth", sheet({lacquer(0.0)}, 0.0), view);
        expect_furnace_as_measured("rough", sheet({layer(1.5, 0.3)}, 0.1), view);
        expect_furnace_as_measured("scattering", sheet({scattering(1.5, 0.0, 0.5)}, 0.0), view);
    }
}

/// A sphere of `m`, a checker in the mixture, under a sky of two colours and a lamp.
Scene specialised_scene(const Material& m) {
    Scene scene = sphere_scene(m, 12, 12);
    scene.materials.push_back(material({}, 0.3));
    scene.surfaces = plain_surfaces(scene);
    Texture checker;
    checker.type = TextureType::Checker;
    checker.size = 0.5;
    scene.textures = {checker};
    scene.surfaces[0].mixed_with = 1;
    scene.surfaces[0].mix_texture = 0;
    Image sky;
    sky.width = 2;
    sky.height = 2;
    sky.rgb = {0.5f, 0.2f, 0.1f, 0.1f, 0.3f, 0.9f, 0.2f, 0.2f, 0.2f, 0.1f, 0.1f, 0.1f};
    scene.images = {sky};
    scene.lights = {EnvironmentLight{Spectrum::constant(1.0), 0, 30.0},
                    RectangleLight{{0, 4, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)}};
    return scene;
}

TEST(Materials, AllFeaturesAgreeWithTheSpecialisedKernels) {
    const Layer paint = with_flakes(scattering(1.5, 0.2, 0.5), 0.3, metal(0.2));
    for (const Material& m : {oren_nayar({layer(1.5)}, 0.5), on_metal({paint}, metal(0.3))}) {
        const Scene scene = specialised_scene(m);
        RenderOptions options;
        options.bands = bands;
        options.samples = 8;
        options.wavelengths.centred = true;
        const RenderResult some = render(scene, device(), options);
        options.all_features = true;
        const RenderResult all = render(scene, device(), options);
        EXPECT_EQ(some.non_finite, 0u);
        EXPECT_FALSE(some.left_out.empty());
        ASSERT_EQ(all.image.values.size(), some.image.values.size());
        for (std::size_t i = 0; i < all.image.values.size(); ++i) {
            const float expected = some.image.values[i];
            EXPECT_NEAR(all.image.values[i], expected, 1e-4f * (expected + 0.1f)) << i;
        }
    }
}

} // namespace
} // namespace reradiant
