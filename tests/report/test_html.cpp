#include "host/report/html.h"

#include <gtest/gtest.h>

using namespace reradiant;

TEST(Html, TextCannotBecomeMarkup) {
    HtmlPage page("<script>alert(1)</script>");
    page.heading("a < b & \"c\"");
    page.table({"<i>"}, {{"</td>"}});
    page.figure("<svg></svg>", "<b>");
    const std::string text = page.text();
    EXPECT_EQ(text.find("<script>"), std::string::npos);
    EXPECT_NE(text.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
    EXPECT_NE(text.find("<th>&lt;i&gt;</th>"), std::string::npos);
    EXPECT_NE(text.find("<td>&lt;/td&gt;</td>"), std::string::npos);
    EXPECT_NE(text.find("<figure><svg></svg><figcaption>&lt;b&gt;"), std::string::npos);
}

TEST(Html, PageNeedsNothingElse) {
    HtmlPage page("report");
    page.paragraph("one");
    const std::string text = page.text();
    for (const char* reference : {"http", "src=", "href=", "<script", "@import", "url("})
        EXPECT_EQ(text.find(reference), std::string::npos) << reference;
}

TEST(Html, NumbersAreSetToTheRightAndWordsAreNot) {
    HtmlPage page("report");
    page.table({"what", "value"}, {{"rank", "3"}, {"yield", "0.9 (0.8 to 1)"}, {"3rd", "-1e-5"}});
    const std::string text = page.text();
    EXPECT_NE(text.find("<td>rank</td><td class=\"number\">3</td>"), std::string::npos);
    EXPECT_NE(text.find("<td class=\"number\">0.9 (0.8 to 1)</td>"), std::string::npos);
    EXPECT_NE(text.find("<td>3rd</td><td class=\"number\">-1e-5</td>"), std::string::npos);
}

TEST(Html, ControlCharactersAndBracesAreHarmless) {
    HtmlPage page("a\nb{0}");
    page.paragraph(std::string("x\0y{}", 5));
    EXPECT_NE(page.text().find("<h1>a b{0}</h1>"), std::string::npos);
    EXPECT_NE(page.text().find("<p>x y{}</p>"), std::string::npos);
}
