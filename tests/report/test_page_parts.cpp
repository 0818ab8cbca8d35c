#include "host/report/page_parts.h"

#include <gtest/gtest.h>

#include <string>

using namespace reradiant;

TEST(PageParts, TitleIsTextAndTheBodyIsMarkup) {
    const std::string page = html_document("a < b & c", "p{}", "<p>x</p>\n");
    EXPECT_NE(page.find("<title>a &lt; b &amp; c</title>"), std::string::npos);
    EXPECT_NE(page.find("<h1>a &lt; b &amp; c</h1>\n<p>x</p>"), std::string::npos);
}

TEST(PageParts, DataCannotCloseTheirElement) {
    const std::string element =
        script_data("numbers", {{"name", "</script><script>alert(1)</script>"}, {"bad", "\xff"}});
    EXPECT_EQ(element.find("</script>"), element.size() - std::string("</script>\n").size());
    EXPECT_NE(element.find("id=\"numbers\""), std::string::npos);
    EXPECT_NE(element.find("\\u003c/script>"), std::string::npos);
}

// What is embedded is the file as it is.
TEST(PageParts, SharedScriptAndStyleAreThere) {
    EXPECT_EQ(std::string(page_script).rfind("'use strict';", 0), 0u);
    EXPECT_NE(std::string(page_script).find("function drawChart("), std::string::npos);
    EXPECT_NE(std::string(page_style).find("prefers-color-scheme:dark"), std::string::npos);
    EXPECT_NE(std::string(report_style).find("figcaption"), std::string::npos);
}
