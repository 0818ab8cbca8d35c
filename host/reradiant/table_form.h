#pragma once

#include "reradiant/reradiation.h"

#include <optional>
#include <string>

namespace reradiant {

/// A `DecimalMark` is the sign that parts the whole from the fraction in a table's numbers.
enum class DecimalMark { Automatic, Comma, Point };

/// A `TableForm` is what the reader of a plain table of numbers is told, since the table does not
/// say it. Where it does, the two must agree.
struct TableForm {
    std::optional<MatrixQuantity> quantity;
    std::optional<bool> rows_are_emission;
    std::optional<double> scale; ///< values are multiplied by it: 0.01 for percent
    std::optional<MatrixKind> kind;
    bool anti_stokes_allowed = false;
    std::optional<std::string> geometry; ///< illumination/viewing, as in 45/0
    DecimalMark decimal = DecimalMark::Automatic;

    bool operator==(const TableForm&) const = default;
};

/// `TableWords` holds a TableForm in a user's words; empty ones say nothing.
struct TableWords {
    std::string rows = {};     ///< emission, excitation (or rows-emission, rows-excitation)
    std::string quantity = {}; ///< per-band, density (or density-per-nm)
    std::string scale = {};    ///< percent, permille or a factor above 0
    std::string decimal = {};  ///< comma, point
    std::string kind = {};     ///< measured, model
    bool anti_stokes = false;
    std::string geometry = {}; ///< 45/0, 8/d and so on
};

/// Returns the form that the words stand for; input Error for other words.
TableForm table_form(const TableWords& words);
/// True for rows = emission; input Error for a word that is none of rows.
bool rows_are_emission(const std::string& rows);
/// Returns the quantity that a word stands for; input Error for a word that is none.
MatrixQuantity matrix_quantity(const std::string& quantity);

} // namespace reradiant
