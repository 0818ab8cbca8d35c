#include "host/figure/wrapped_text.h"

#include "host/figure/svg_drawing.h"

#include <sstream>

namespace reradiant {

namespace {

/// Takes characters (of UTF-8, which may have several bytes) off the end until the rest and an
/// ellipsis fit.
std::string shortened(std::string word, double width, bool is_bold) {
    if (text_width(word, is_bold) <= width)
        return word;
    const auto is_inside = [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xc0) == 0x80;
    };
    while (!word.empty() && text_width(word + "…", is_bold) > width) {
        while (word.size() > 1 && is_inside(word.back()))
            word.pop_back();
        word.pop_back();
    }
    return word + "…";
}

} // namespace

std::vector<std::string> wrapped_text(const std::string& text, double width, bool is_bold) {
    std::vector<std::string> lines;
    std::istringstream paragraphs(text);
    for (std::string paragraph; std::getline(paragraphs, paragraph);) {
        std::istringstream words(paragraph);
        std::string line;
        for (std::string word; words >> word;) {
            const std::string longer = line.empty() ? word : line + " " + word;
            if (!line.empty() && text_width(longer, is_bold) > width) {
                lines.push_back(line);
                line = shortened(word, width, is_bold);
            } else {
                line = line.empty() ? shortened(word, width, is_bold) : longer;
            }
        }
        lines.push_back(line);
    }
    return lines;
}

} // namespace reradiant
