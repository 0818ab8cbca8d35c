#include "host/scene/model/model_choice.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

Material lacquer(double alpha = 0.2) {
    Material material;
    material.stack.layers.emplace_back().alpha = alpha;
    return material;
}
Material metal() {
    Material material = lacquer();
    material.substrate.type = SubstrateType::Conductor;
    return material;
}
Material flaked() {
    Material material = lacquer();
    material.stack.layers.front().flakes = Flakes{0.2, {}};
    material.stack.layers.front().flakes->reflector.alpha = 0.2;
    return material;
}
Material filmed(double alpha) {
    Material material = lacquer(alpha);
    material.stack.layers.front().film = ThinFilm{};
    return material;
}

TEST(ModelChoice, AutoIsAddingWhereverItCanDoTheMaterial) {
    for (const ModelUse use : {ModelUse::Measure, ModelUse::Render}) {
        for (const Material& material : {lacquer(), filmed(0.0)}) {
            const ModelChoice choice = choose_model(material, Model::Auto, use);
            EXPECT_EQ(choice.model, Model::Adding);
            EXPECT_EQ(choice.reason.rfind("auto: adding", 0), 0U);
        }
    }
}

TEST(ModelChoice, AutoElsewhereIsTheWalk) {
    for (const Material& material : {metal(), flaked()}) {
        for (const ModelUse use : {ModelUse::Measure, ModelUse::Render}) {
            const ModelChoice choice = choose_model(material, Model::Auto, use);
            EXPECT_EQ(choice.model, Model::Walk);
            EXPECT_NE(choice.reason.find("adding does not know"), std::string::npos);
        }
    }
}

void expect_approximation(const Material& material, ModelUse use, const char* reason) {
    const ModelChoice choice = choose_model(material, Model::Auto, use);
    EXPECT_EQ(choice.model, Model::WeidlichWilkie);
    EXPECT_NE(choice.reason.find(reason), std::string::npos) << choice.reason;
    EXPECT_NE(choice.reason.find("energy is not bounded"), std::string::npos) << choice.reason;
    EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Walk);
}

TEST(ModelChoice, AutoApproximatesWhatTheDeviceCannotWalk) {
    expect_approximation(filmed(0.2), ModelUse::Render, "films");
    Material smooth_flakes = flaked();
    smooth_flakes.stack.layers.front().flakes->reflector.alpha = 0.0;
    expect_approximation(smooth_flakes, ModelUse::Render, "smooth flakes");
    Material dispersive = metal();
    dispersive.stack.layers.front().ior = Spectrum::table({400, 700}, {1.6, 1.5});
    expect_approximation(dispersive, ModelUse::Render, "depend on wavelength");
    expect_approximation(metal(), ModelUse::RenderHero, "hero");
}

TEST(ModelChoice, AutoTakesTheClosedFormOfBareConductors) {
    Material bare = metal();
    bare.stack.layers.clear();
    EXPECT_EQ(choose_model(bare, Model::Auto, ModelUse::Render).model, Model::WeidlichWilkie);
    EXPECT_EQ(choose_model(bare, Model::Auto, ModelUse::Measure).model, Model::Walk);
}

TEST(ModelChoice, ANamedModelIsTakenAndTheRequestBeatsTheFile) {
    Material material = metal();
    material.model = Model::WeidlichWilkie;
    EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::WeidlichWilkie);
    EXPECT_EQ(choose_model(material, Model::Walk, ModelUse::Render).model, Model::Walk);
    EXPECT_TRUE(choose_model(material, Model::Walk, ModelUse::Render).reason.empty());
}

TEST(ModelChoice, AddingByNameIsRefusedWhereItCannotDoTheMaterial) {
    for (const Material& material : {metal(), flaked(), filmed(0.2)}) {
        EXPECT_THROW(choose_model(material, Model::Adding, ModelUse::Measure), Error);
        EXPECT_THROW(choose_model(material, Model::Adding, ModelUse::Render), Error);
    }
}

Material dyed() {
    Material material = lacquer();
    material.stack.layers.front().dyes.push_back(
        {Spectrum::constant(1.0), 1.0, Spectrum::gaussian(600.0, 20.0, 1.0), 0.9, nullptr});
    return material;
}
Material sheet() {
    Material material = lacquer();
    material.stack.lower_face.emplace();
    material.substrate.type = SubstrateType::None;
    return material;
}
void add_flakes(Material& material) {
    material.stack.layers.front().flakes = flaked().stack.layers.front().flakes;
}

TEST(ModelChoice, DyesAndSheetsAreForAddingWhereverItCanDoThem) {
    for (const ModelUse use : {ModelUse::Measure, ModelUse::Render, ModelUse::RenderHero})
        EXPECT_EQ(choose_model(dyed(), Model::Auto, use).model, Model::Adding);
    const ModelChoice choice = choose_model(sheet(), Model::Auto, ModelUse::Measure);
    EXPECT_EQ(choice.model, Model::Adding);
    EXPECT_NE(choice.reason.find("sheet"), std::string::npos);
}

TEST(ModelChoice, WeidlichWilkieIsRefusedForDyesAndSheets) {
    for (Material material : {dyed(), sheet()}) {
        EXPECT_THROW(choose_model(material, Model::WeidlichWilkie, ModelUse::Measure), Error);
        material.model = Model::WeidlichWilkie;
        EXPECT_THROW(choose_model(material, Model::Auto, ModelUse::Render), Error);
    }
    Material pale = dyed();
    pale.stack.layers.front().dyes.front().concentration = 0.0;
    EXPECT_EQ(choose_model(pale, Model::WeidlichWilkie, ModelUse::Render).model,
              Model::WeidlichWilkie);
}

TEST(ModelChoice, AddingHasNoOrenNayarSubstratesBeneathDyes) {
    Material material = dyed();
    material.substrate.type = SubstrateType::OrenNayar;
    material.substrate.sigma = 0.3;
    EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Walk);
    EXPECT_THROW(choose_model(material, Model::Adding, ModelUse::Measure), Error);
    material.substrate.sigma = 0.0; // a Lambertian substrate
    EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Adding);
}

/// What adding cannot do is walked, in pictures too, and no picture is made of it by approximation.
TEST(ModelChoice, SheetsBeyondAddingAreWalked) {
    for (Material material : {dyed(), sheet()}) {
        add_flakes(material);
        EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Walk);
    }
    EXPECT_EQ(choose_model(sheet(), Model::Auto, ModelUse::Render).model, Model::Adding);
    EXPECT_EQ(choose_model(dyed(), Model::Auto, ModelUse::Render).model, Model::Adding);
    EXPECT_EQ(choose_model(sheet(), Model::Walk, ModelUse::Render).model, Model::Walk);
    EXPECT_EQ(device_walk_refusal(sheet()), std::nullopt);
    Material flaked_sheet = sheet(), flaked_dye = dyed();
    add_flakes(flaked_sheet);
    EXPECT_EQ(choose_model(flaked_sheet, Model::Auto, ModelUse::Render).model, Model::Walk);
    EXPECT_EQ(device_walk_refusal(flaked_sheet), "the renderer's walk knows no flakes in sheets");
    add_flakes(flaked_dye);
    EXPECT_EQ(choose_model(flaked_dye, Model::Auto, ModelUse::Render).model, Model::Walk);
}

TEST(ModelChoice, AddingKnowsRoughInterfacesOfSheetsAsFacesAlone) {
    Material material = sheet();
    material.stack.lower_face = LowerFace{.alpha = 0.2};
    EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Adding);
    material.stack.layers.push_back(material.stack.layers.front());
    material.stack.layers.back().alpha = 0.2;
    for (const ModelUse use : {ModelUse::Measure, ModelUse::Render})
        EXPECT_EQ(choose_model(material, Model::Auto, use).model, Model::Walk);
}

} // namespace
} // namespace reradiant
