#include "reradiant/spectral_files.h"

#include "host/spectral/text/text_reader.h"
#include "reradiant/error.h"

#include <fmt/core.h>

namespace reradiant {

namespace {

/// Returns whether a word is the first of two; input Error where it is neither.
bool is_first(const char* name, const std::string& word, const std::string& first,
              const std::string& second) {
    if (word != first && word != second)
        throw_input_error({}, fmt::format("{}: '{}' is not known", name, word),
                          fmt::format("give {} or {}", first, second));
    return word == first;
}

double scale_of(const std::string& text) {
    if (text == "percent" || text == "%")
        return 0.01;
    if (text == "permille")
        return 0.001;
    const double scale = begins_as_number(text) && is_number(text) ? number_at(text, {}) : 0.0;
    if (!(scale > 0.0))
        throw_input_error({}, fmt::format("scale: '{}' is no scale of values", text),
                          "give percent, permille or a factor above 0");
    return scale;
}

} // namespace

bool rows_are_emission(const std::string& rows) {
    const std::string prefix = "rows-";
    return is_first("rows", rows.starts_with(prefix) ? rows.substr(prefix.size()) : rows,
                    "emission", "excitation");
}

MatrixQuantity matrix_quantity(const std::string& quantity) {
    return is_first("quantity", quantity == "density-per-nm" ? "density" : quantity, "per-band",
                    "density")
               ? MatrixQuantity::PerBand
               : MatrixQuantity::DensityPerNm;
}

TableForm table_form(const TableWords& words) {
    TableForm form;
    if (!words.rows.empty())
        form.rows_are_emission = rows_are_emission(words.rows);
    if (!words.quantity.empty())
        form.quantity = matrix_quantity(words.quantity);
    if (!words.scale.empty())
        form.scale = scale_of(words.scale);
    if (!words.decimal.empty())
        form.decimal = is_first("decimal", words.decimal, "comma", "point") ? DecimalMark::Comma
                                                                            : DecimalMark::Point;
    if (!words.kind.empty())
        form.kind = is_first("kind", words.kind, "measured", "model") ? MatrixKind::Measured
                                                                      : MatrixKind::Model;
    form.anti_stokes_allowed = words.anti_stokes;
    if (!words.geometry.empty())
        form.geometry = words.geometry;
    return form;
}

} // namespace reradiant
