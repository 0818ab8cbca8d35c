#pragma once

#include <string>
#include <vector>

namespace reradiant {

/// A report as one self-contained HTML file: no script, no network, readable in light, in the dark
/// and on paper, and well-formed XML too. Text is escaped; figures are SVG elements as
/// host/report/svg.h makes them.
class HtmlPage {
public:
    explicit HtmlPage(std::string title);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    /// Rows may be shorter than the header. Cells that are numbers are set to the right.
    void table(const std::vector<std::string>& header,
               const std::vector<std::vector<std::string>>& rows);
    void figure(const std::string& svg, const std::string& caption);

    std::string text() const;

private:
    std::string title_, body_;
};

/// Text with the characters that HTML and SVG reserve escaped; control characters become spaces.
std::string markup_escaped(const std::string& text);

} // namespace reradiant
