#include "host/report/html.h"

#include <fmt/core.h>

#include <cstdlib>

namespace reradiant {

namespace {

constexpr const char* style =
    "body{font:16px/1.45 Helvetica,Arial,sans-serif;color:#222;background:#fff;"
    "max-width:72em;margin:2em auto;padding:0 1em}\n"
    "h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2em;border-bottom:1px solid #ccc}\n"
    "table{border-collapse:collapse;margin:1em 0;display:block;overflow-x:auto}\n"
    "th,td{padding:.25em .8em;border-bottom:1px solid #ddd;text-align:left}\n"
    "th{border-bottom:2px solid #888}td.number{text-align:right;white-space:nowrap;"
    "font-variant-numeric:tabular-nums}\n"
    "figure{display:inline-block;margin:1em 1em 1em 0;vertical-align:top}\n"
    "figure svg{max-width:100%;height:auto}\n"
    "figcaption{font-size:.9em;color:#555;max-width:42em}\n";

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
    const std::string title = markup_escaped(title_);
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
                       "<meta name=\"viewport\" content=\"width=device-width\"/>\n"
                       "<title>{0}</title>\n<style>\n{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
                       "{2}</body></html>\n",
                       title, style, body_);
}

} // namespace reradiant
