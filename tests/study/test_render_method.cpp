#include "host/study/converge/render_method.h"

#include "reradiant/error.h"

#include <gtest/gtest.h>

namespace reradiant {
namespace {

std::string refusal(const std::string& list) {
    try {
        parse_methods(list);
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2);
        return error.what();
    }
    ADD_FAILURE() << "'" << list << "' was taken";
    return {};
}

TEST(RenderMethod, PartsAreReadInAnyOrder) {
    const RenderMethod both = parse_method("comb:16+weidlich-wilkie");
    EXPECT_EQ(both.model, Model::WeidlichWilkie);
    EXPECT_EQ(both.comb_count, 16);
    EXPECT_EQ(parse_method("comb").model, Model::Auto);
    EXPECT_EQ(parse_method("adding").comb_count, 0);
    EXPECT_EQ(parse_method("hero").hero_count, 4);
    EXPECT_EQ(parse_method("weidlich-wilkie+hero:16").hero_count, 16);
    EXPECT_EQ(parse_methods("adding,walk,comb:8").size(), 3u);
    EXPECT_FALSE(both.adaptive);
    EXPECT_TRUE(parse_method("adaptive").adaptive);
    EXPECT_TRUE(parse_method("walk+hero:8+adaptive").adaptive);
}

TEST(RenderMethod, WhatIsNotKnownIsNamed) {
    EXPECT_NE(refusal("adding,magic").find("--methods: 'magic'"), std::string::npos);
    EXPECT_NE(refusal("adding+heron").find("'heron'"), std::string::npos);
    EXPECT_NE(refusal("adding+walk").find("two models"), std::string::npos);
    EXPECT_NE(refusal("adding,adding").find("twice"), std::string::npos);
    for (const char* text : {"", "adding,", "comb:0", "comb:-1", "comb:4097", "comb:", "comb:8x",
                             "adding+", "comb:8+comb:9", "hero:0", "hero:17", "comb+hero"})
        EXPECT_NE(refusal(text).find("--methods"), std::string::npos) << text;
}

TEST(RenderMethod, FileNamesHoldNoColon) {
    EXPECT_EQ(parse_method("adding+comb:16").file_stem(), "adding+comb-16");
}

} // namespace
} // namespace reradiant
