#pragma once

#include "host/study/study/study.h"

namespace reradiant {

/// index.html of a study: cells to pick from, pictures, spectra and re-radiation to be read under
/// the pointer. One file that needs no other and no network.
std::string study_page(const Study& study, const StudyResult& result);

/// Style and script of the page.
extern const char* const study_style;
extern const char* const study_script;

} // namespace reradiant
