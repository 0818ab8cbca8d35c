// What is kept of dyed materials on disk, and shared between materials.
#include "host/render/dyes/dyed_file.h"
#include "host/render/dyes/dyed_key.h"
#include "host/render/tables/stack_optics.h"
#include "tests/render/test_scenes.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

namespace reradiant {
namespace {

using namespace test;
namespace fs = std::filesystem;

const PrivateCache cache("dyed-cache");
const WavelengthGrid bands = grid_from_range(450, 650, 40);

Layer dyed_layer(double concentration) {
    Layer layer = test::layer(1.5, 0.0, 0.1);
    SlabDye dye;
    dye.absorption = Spectrum::table({430, 500, 560}, {0.0, 2.0, 0.0});
    dye.emission = Spectrum::table({480, 560, 700}, {0.0, 1.0, 0.0});
    dye.concentration = concentration;
    layer.dyes = {dye};
    return layer;
}

Scene lit(const Material& material) {
    Scene scene = plane_scene(material, 20.0, 4, 4);
    scene.lights = {environment(Spectrum::constant(1.0))};
    return scene;
}

DyedOperator operator_of(const Material& material) {
    const WavelengthPlan plan = plan_wavelengths(lit(material), bands, {});
    return dyed_operator(material, {}, plan);
}

Material sheet_of(Layer layer) {
    Material sheet = material({std::move(layer)}, 0.0);
    sheet.substrate.type = SubstrateType::None;
    sheet.stack.lower_face = LowerFace{};
    return sheet;
}

void expect_same(const DyedOperator& a, const DyedOperator& b) {
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.cells, b.cells);
    EXPECT_EQ(a.depth_error, b.depth_error);
    EXPECT_EQ(a.channel_error, b.channel_error);
    EXPECT_EQ(a.shifts_up, b.shifts_up);
    EXPECT_EQ(a.terms, b.terms);
    EXPECT_EQ(a.factor_error, b.factor_error);
    ASSERT_EQ(a.phases.size(), b.phases.size());
    for (std::size_t phase = 0; phase < a.phases.size(); ++phase) {
        const ChannelOperator &x = a.phases[phase], &y = b.phases[phase];
        EXPECT_EQ(x.reached, y.reached);
        EXPECT_EQ(x.coupling, y.coupling);
        EXPECT_EQ(x.factors.within, y.factors.within);
        EXPECT_EQ(x.factors.sent, y.factors.sent);
        EXPECT_EQ(x.factors.taken, y.factors.taken);
        EXPECT_EQ(x.factors.error, y.factors.error);
    }
}

std::vector<fs::path> kept_files() {
    std::vector<fs::path> files;
    if (fs::is_directory(dyed_folder()))
        for (const auto& entry : fs::directory_iterator(dyed_folder()))
            files.push_back(entry.path());
    return files;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void put_bytes(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// A cache without dyes, for every test.
class DyedCache : public ::testing::Test {
protected:
    DyedCache() { fs::remove_all(dyed_folder()); }
};

} // namespace

TEST_F(DyedCache, Case43KeptOperatorsAreTheComputedOnesToTheBit) {
    for (const Material& own : {material({dyed_layer(1.0)}, 0.5), sheet_of(dyed_layer(1.0))}) {
        const std::size_t before = kept_files().size();
        const DyedOperator computed = operator_of(own);
        EXPECT_EQ(kept_files().size(), before + 1);
        expect_same(computed, operator_of(own));
        EXPECT_EQ(kept_files().size(), before + 1);
    }
}

TEST_F(DyedCache, PictureIsTheSameToTheBit) {
    const Scene scene = lit(material({dyed_layer(0.7)}, 0.5));
    RenderOptions options;
    options.samples = 4;
    options.bands = bands;
    const RenderResult computed = render(scene, device(), options);
    ASSERT_EQ(kept_files().size(), 1u);
    EXPECT_EQ(computed.image.values, render(scene, device(), options).image.values);
}

TEST_F(DyedCache, DamagedFilesAreComputedAgain) {
    const Material own = material({dyed_layer(1.0)}, 0.5);
    const DyedOperator computed = operator_of(own);
    const fs::path file = kept_files().front();
    const std::string whole = bytes_of(file);
    std::string changed = whole, header = whole;
    changed[whole.size() / 2] ^= '\x20';
    header[12] ^= '\x01'; // of the key: a file of another material
    for (const std::string& damaged :
         {changed, header, whole.substr(0, whole.size() / 2), whole.substr(0, 20),
          whole + "12345678", whole + "1", std::string()}) {
        put_bytes(file, damaged);
        expect_same(computed, operator_of(own));
        EXPECT_EQ(bytes_of(file), whole) << "written again";
    }
}

TEST_F(DyedCache, CacheThatCannotBeWrittenIsNoError) {
    put_bytes(dyed_folder(), "no folder");
    const Material own = material({dyed_layer(1.0)}, 0.5);
    expect_same(operator_of(own), operator_of(own));
    EXPECT_TRUE(fs::is_regular_file(dyed_folder()));
    fs::remove(dyed_folder());
}

TEST_F(DyedCache, FilesThatWereUsedLongestAgoMakeRoom) {
    const DyedOperator dyes = operator_of(material({dyed_layer(1.0)}, 0.5));
    const std::uintmax_t size = fs::file_size(kept_files().front());
    fs::remove_all(dyed_folder());
    const std::uintmax_t room = 4 * size + 3;
    const auto key = [](char digit) { return std::string(64, digit); };
    for (const char digit : {'1', '2', '3', '4'}) {
        keep_dyed_operator(key(digit), dyes, room);
        fs::last_write_time(dyed_folder() / (key(digit) + ".bin"),
                            fs::file_time_type::clock::now() - std::chrono::hours('9' - digit));
    }
    EXPECT_TRUE(read_dyed_file(key('1'))) << "it is the last one used now";
    keep_dyed_operator(key('5'), dyes, room);
    EXPECT_EQ(kept_files().size(), 4u);
    EXPECT_TRUE(read_dyed_file(key('1')));
    EXPECT_FALSE(read_dyed_file(key('2')));
    keep_dyed_operator(key('6'), dyes, 4 * size - 4);
    EXPECT_FALSE(read_dyed_file(key('6'))) << "more than a quarter of the room";
}

TEST_F(DyedCache, KeyTellsApartWhateverAnOperatorDependsOn) {
    const DyedStack plain{{{SurfaceValues{}, SlabValues{}, FlakesValues{}, DiffuseValues{}}},
                          {Eigen::MatrixXd::Constant(2, 2, 0.1)},
                          Eigen::MatrixXd::Constant(2, 2, 0.2)};
    using Change = std::function<void(DyedStack&)>;
    const auto surface = [](auto member, auto value) -> Change {
        return [=](DyedStack& s) { std::get<SurfaceValues>(s.by_band[0][0]).*member = value; };
    };
    const auto slab = [](auto member, auto value) -> Change {
        return [=](DyedStack& s) { std::get<SlabValues>(s.by_band[0][1]).*member = value; };
    };
    const std::vector<Change> changes = {
        [](DyedStack&) {},
        surface(&SurfaceValues::ior_above, 1.1),
        surface(&SurfaceValues::ior_below, 1.6),
        surface(&SurfaceValues::kappa, 0.1),
        surface(&SurfaceValues::is_conductor, true),
        surface(&SurfaceValues::distribution, Distribution::Blinn),
        surface(&SurfaceValues::alpha, 0.1),
        surface(&SurfaceValues::scattering, Scattering::Single),
        surface(&SurfaceValues::film, FilmValues{100.0, 1.0}),
        surface(&SurfaceValues::film, FilmValues{0.0, 1.4}),
        surface(&SurfaceValues::wavelength_nm, 500.0),
        slab(&SlabValues::ior, 1.6),
        slab(&SlabValues::tau, 0.1),
        slab(&SlabValues::tau_scattering, 0.1),
        slab(&SlabValues::anisotropy, 0.1),
        slab(&SlabValues::may_scatter, true),
        slab(&SlabValues::tau_dyes, 0.1),
        [](DyedStack& s) { std::get<FlakesValues>(s.by_band[0][2]).coverage = 0.1; },
        [](DyedStack& s) { std::get<FlakesValues>(s.by_band[0][2]).reflector.kappa = 0.1; },
        [](DyedStack& s) { std::get<DiffuseValues>(s.by_band[0][3]).ior_above = 1.1; },
        [](DyedStack& s) { std::get<DiffuseValues>(s.by_band[0][3]).sigma = 0.1; },
        [](DyedStack& s) { s.by_band.push_back(s.by_band[0]); },
        [](DyedStack& s) { s.slabs[0](1, 0) = 0.3; },
        [](DyedStack& s) { s.slabs.push_back({}); },
        [](DyedStack& s) { s.substrate(1, 0) = 0.3; },
        [](DyedStack& s) { s.substrate.resize(0, 0); },
    };
    std::vector<std::string> keys;
    for (const Change& change : changes) {
        DyedStack stack = plain;
        change(stack);
        const std::string key = dyed_key({stack});
        EXPECT_EQ(key, dyed_key({stack}));
        EXPECT_EQ(std::ranges::count(keys, key), 0) << "change " << keys.size();
        keys.push_back(key);
    }
}

TEST(MaterialOptics, StacksThatAreAlikeAreComputedOnce) {
    std::deque<MaterialOptics> recent;
    const auto optics = [&](const Material& own, Model model = Model::Adding) {
        return MaterialOptics(own, model, plan_wavelengths(lit(own), bands, {}), recent);
    };
    const MaterialOptics first = optics(material({dyed_layer(1.0)}, 0.5));
    EXPECT_EQ(&optics(material({dyed_layer(1.0)}, 0.2)).any(), &first.any()) << "another substrate";
    EXPECT_NE(&optics(material({dyed_layer(1.1)}, 0.5)).any(), &first.any());
    EXPECT_NE(&optics(material({dyed_layer(1.0)}, 0.5), Model::WeidlichWilkie).any(), &first.any());
    for (int k = 0; k < 20; ++k)
        optics(material({dyed_layer(2.0 + k)}, 0.5));
    EXPECT_EQ(recent.size(), 8u);
    EXPECT_NE(&optics(material({dyed_layer(1.0)}, 0.5)).any(), &first.any()) << "forgotten";
}

} // namespace reradiant
