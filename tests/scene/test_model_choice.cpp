#include "host/scene/model_choice.h"

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

TEST(ModelChoice, AutoElsewhereIsExactInMeasurementsAndFastInPictures) {
    for (const Material& material : {metal(), flaked(), filmed(0.2)}) {
        EXPECT_EQ(choose_model(material, Model::Auto, ModelUse::Measure).model, Model::Walk);
        const ModelChoice render = choose_model(material, Model::Auto, ModelUse::Render);
        EXPECT_EQ(render.model, Model::WeidlichWilkie);
        EXPECT_NE(render.reason.find("walk is exact"), std::string::npos);
        EXPECT_NE(render.reason.find("adding does not know"), std::string::npos);
    }
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
