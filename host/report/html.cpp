#include "host/report/html.h"

#include "host/report/page_parts.h"

#include <fmt/core.h>

#include <cstdlib>

namespace reradiant {

namespace {

/// True for text that begins as a number does; "0.91 (0.90 to 0.92)" is one to readers.
bool is_number(const std::string& text) {
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    return end != text.c_str() && (*end == '\0' || *end == ' ' || *end == '.');
}

} // namespace

std::string markup_escaped(const std::string& text) {
    std::string result;
    for (const char character : text)
        switch (character) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += static_cast<unsigned char>(character) < 0x20 ? ' ' : character;
        }
    return result;
}

HtmlPage::HtmlPage(std::string title) : title_(std::move(title)) {}

void HtmlPage::heading(const std::string& text) {
    body_ += fmt::format("<h2>{}</h2>\n", markup_escaped(text));
}

void HtmlPage::paragraph(const std::string& text) {
    body_ += fmt::format("<p>{}</p>\n", markup_escaped(text));
}

void HtmlPage::table(const std::vector<std::string>& header,
                     const std::vector<std::vector<std::string>>& rows) {
    body_ += "<table><thead><tr>";
    for (const std::string& cell : header)
        body_ += fmt::format("<th>{}</th>", markup_escaped(cell));
    body_ += "</tr></thead><tbody>\n";
    for (const std::vector<std::string>& row : rows) {
        body_ += "<tr>";
        for (const std::string& cell : row)
            body_ += fmt::format("<td{}>{}</td>", is_number(cell) ? " class=\"number\"" : "",
                                 markup_escaped(cell));
        body_ += "</tr>\n";
    }
    body_ += "</tbody></table>\n";
}

void HtmlPage::figure(const std::string& svg, const std::string& caption) {
    body_ += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg,
                         markup_escaped(caption));
}

std::string HtmlPage::text() const {
    return html_document(title_, std::string(page_style) + report_style, body_);
}

} // namespace reradiant
