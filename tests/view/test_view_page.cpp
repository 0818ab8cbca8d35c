#include "host/view/view_page.h"
#include "reradiant/error.h"
#include "tests/view/shown_page.h"

namespace reradiant {

namespace {

constexpr const char* hostile = "</script><script>alert('\"&<b>')</script>";

} // namespace

TEST(ViewPage, NamesCannotBecomeMarkup) {
    ViewedMaterial viewed = viewed_preset("neon-orange-bare");
    viewed.name = hostile;
    Lamp lamp = lamp_from_text("D65");
    lamp.name = hostile;
    const std::string page = page_of(viewed, {lamp});
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
}

TEST(ViewPage, NeedsNothingElse) {
    const std::string page = page_of(viewed_preset("neon-orange-bare"));
    for (const char* reference : {"http:", "https:", "src=", "href=", "@import", "url("})
        EXPECT_EQ(page.find(reference), std::string::npos) << reference;
}

// The goal is 1.5 MB; rough stacks with a spectral absorption have the most tables.
TEST(ViewPage, IsSmallEnoughToSend) {
    for (const char* preset : {"fluorescent-orange-rough", "fluorescent-pigment", "multi-layer",
                               "soap-film", "lepidolite-flake", "fluorescent-varnish-on-white"})
        EXPECT_LT(page_of(viewed_preset(preset)).size(), 1500000u) << preset;
}

TEST(ViewPage, MaterialsThatOnlyTheWalkDoesAreShownWithANote) {
    for (const char* preset : {"multi-layer", "pearlescent-paint", "silver-paint"}) {
        const ViewedModels viewed = viewed_models(viewed_preset(preset).material);
        EXPECT_EQ(viewed.models, std::vector<Model>{Model::WeidlichWilkie}) << preset;
        ASSERT_EQ(viewed.notes.size(), 1u) << preset;
        EXPECT_NE(viewed.notes.front().find("approximate"), std::string::npos);
    }
    EXPECT_TRUE(viewed_models(viewed_preset("red-lacquer").material).notes.empty());
    const ViewedModels dyed = viewed_models(viewed_preset("fluorescent-varnish-on-white").material);
    EXPECT_EQ(dyed.models, std::vector<Model>{Model::Adding});
    EXPECT_NE(dyed.notes.front().find("nothing of them slides"), std::string::npos);
}

TEST(ViewPage, ModelThatTheFileNamesIsTheOneThatThePageBeginsWith) {
    Material material = viewed_preset("red-lacquer").material;
    material.model = Model::WeidlichWilkie;
    EXPECT_EQ(viewed_models(material).models.front(), Model::WeidlichWilkie);
    material.model = Model::Walk;
    EXPECT_EQ(viewed_models(material).models.front(), Model::Adding);
    EXPECT_EQ(viewed_models(material).notes.size(), 1u);
}

TEST(ViewPage, SheetsAreRefusedAtTheirPlace) {
    for (const char* preset : {"phosphor-sheet", "red-foil-concentrator"}) {
        const Material material = viewed_preset(preset).material;
        EXPECT_FALSE(is_shown_on_pages(material)) << preset;
        try {
            viewed_models(material);
            ADD_FAILURE() << preset << " was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            EXPECT_NE(std::string(error.what()).find("render"), std::string::npos);
        }
    }
}

TEST(ViewPage, LampsThatAreAskedForStandFirst) {
    const std::string page =
        page_of(viewed_preset("neon-orange-bare"), {lamp_from_text("FL3.15"), lamp_from_text("A")});
    const std::size_t first = page.find("\"name\":\"FL3.15\""),
                      second = page.find("\"name\":\"A\"");
    EXPECT_LT(first, second);
    EXPECT_LT(second, page.find("\"name\":\"D65\""));
    EXPECT_EQ(page.find("\"name\":\"A\"", second + 1), std::string::npos) << "once is enough";
}

} // namespace reradiant
