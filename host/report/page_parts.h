#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace reradiant {

/// Style and script that pages share, of host/report/page: colours in light, in the dark and on
/// paper; elements, encoded numbers, charts of spectra.
extern const char* const page_style;
extern const char* const page_script;
/// Style of reports beside that (host/report/html.h).
extern const char* const report_style;

/// A whole document. The title is escaped; style and body are not.
std::string html_document(const std::string& title, const std::string& style,
                          const std::string& body);

/// A script element that holds data, which the page finds by its id: no text of it can close the
/// element.
std::string script_data(const std::string& id, const nlohmann::ordered_json& data);

} // namespace reradiant
