#include "host/report/page_parts.h"

#include "host/report/html.h"

#include <fmt/core.h>

namespace reradiant {

std::string html_document(const std::string& title, const std::string& style,
                          const std::string& body) {
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
                       "<meta name=\"viewport\" content=\"width=device-width\"/>\n"
                       "<title>{0}</title>\n<style>\n{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
                       "{2}</body></html>\n",
                       markup_escaped(title), style, body);
}

std::string script_data(const std::string& id, const nlohmann::ordered_json& data) {
    constexpr auto on_bad_utf8 = nlohmann::ordered_json::error_handler_t::replace;
    const std::string text = data.dump(-1, ' ', true, on_bad_utf8);
    std::string safe;
    for (const char character : text)
        safe += character == '<' ? std::string("\\u003c") : std::string(1, character);
    return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, safe);
}

} // namespace reradiant
