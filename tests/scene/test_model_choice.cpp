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

} // namespace
} // namespace reradiant
