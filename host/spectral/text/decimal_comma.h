#pragma once

#include "reradiant/spectral_files.h"

#include <string>

namespace reradiant {

/// Makes points of the decimal commas in the numbers of a table, so that every cell keeps its
/// place. Automatic does so where nothing else can be meant: the numbers are whole cells between
/// semicolons, tabs, blanks or quotation marks, none in a row has a point, and one at least is no
/// thousand such as 1,234. Returns what would settle the doubt where there is one, else an empty
/// text. With Comma, input Error for a point in a row and for rows whose cells commas separate.
std::string write_decimal_points(std::string& text, DecimalMark mark, const std::string& file);

} // namespace reradiant
