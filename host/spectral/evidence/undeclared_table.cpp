#include "host/spectral/evidence/undeclared_table.h"

#include "host/spectral/evidence/matrix_evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace reradiant {

namespace {

/// Values of unit 1 stay below this but for outliers; those of a hundred times that are permille.
constexpr double largest_of_unit_one = 1.5;

/// Returns the name of a file as a shell takes it, in quotation marks where it needs them.
std::string quoted(const std::string& file) {
    const bool is_plain = std::all_of(file.begin(), file.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c >= 0x80 ||
               std::string_view("._-/+,").find(static_cast<char>(c)) != std::string_view::npos;
    });
    const std::string name = file.starts_with('-') ? "./" + file : file; // no option
    if (is_plain)
        return name;
    std::string text = "'";
    for (const char c : name)
        text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

/// A `Guess` says what the values of a table speak for, in words for an error.
class Guess {
public:
    explicit Guess(const UndeclaredTable& table) : table_(table) {
        if (!table.as_rows_emission)
            return;
        matrix_ = *table.as_rows_emission;
        matrix_.values =
            matrix_.values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
        guess_scale();
        guess_orientation();
        guess_quantity();
        is_noisy_ =
            table.has_gaps || (matrix_.values.array() < -1e-6).any() || evidence_.anti_stokes > 0.0;
    }

    std::string sentence() const {
        return sentences_.empty() ? std::string()
                                  : fmt::format(" ({})", fmt::join(sentences_, "; "));
    }

    /// The options that declare the table; a doubtful one has its other value behind it.
    std::string options() const {
        std::vector<std::string> words;
        words.push_back(std::string("--rows ") + (rows_are_emission() ? "emission" : "excitation"));
        words.push_back(std::string("--quantity ") + (is_density() ? "density" : "per-band"));
        if (!scale_.empty())
            words.push_back("--scale " + scale_);
        if (table_.needs_decimal || table_.told.decimal == DecimalMark::Comma)
            words.push_back("--decimal comma");
        if ((is_noisy_ && !table_.is_measured) || table_.told.kind == MatrixKind::Measured)
            words.push_back("--kind measured");
        if (table_.told.anti_stokes_allowed)
            words.push_back("--anti-stokes");
        if (table_.told.geometry)
            words.push_back("--geometry " + quoted(*table_.told.geometry));
        return fmt::format("{}", fmt::join(words, " "));
    }

    /// Returns the options that the values do not settle, in brackets; empty where there are none.
    std::string doubt() const {
        std::vector<std::string> choices;
        if (!table_.rows_are_emission && !rows_)
            choices.push_back("'--rows excitation' where every row is one excitation");
        if (!table_.quantity && !quantity_)
            choices.push_back("'--quantity density' where values are per nm of excitation");
        return choices.empty() ? std::string() : fmt::format(" ({})", fmt::join(choices, ", "));
    }

    std::string lines() const {
        std::vector<std::string> lines;
        if (!table_.quantity)
            lines.push_back(is_density() ? "'# quantity: density-per-nm'"
                                         : "'# quantity: per-band'");
        if (!table_.rows_are_emission)
            lines.push_back(rows_are_emission() ? "'# orientation: rows-emission'"
                                                : "'# orientation: rows-excitation'");
        if (scale_ == "percent")
            lines.push_back("'# unit: percent'");
        if (is_noisy_ && !table_.is_measured)
            lines.push_back("'# kind: measured'");
        return fmt::format("{}", fmt::join(lines, ", "));
    }

private:
    bool rows_are_emission() const {
        return table_.rows_are_emission.value_or(rows_.value_or(true));
    }
    bool is_density() const {
        return table_.quantity.value_or(quantity_.value_or(MatrixQuantity::PerBand)) ==
               MatrixQuantity::DensityPerNm;
    }

    void guess_scale() {
        if (table_.told.scale) {
            scale_ = fmt::format("{:g}", *table_.told.scale);
            return;
        }
        const double largest = matrix_.values.cwiseAbs().maxCoeff();
        if (table_.has_percent_signs || table_.is_scaled || largest <= largest_of_unit_one) {
            matrix_.values /= table_.has_percent_signs ? 100.0 : 1.0;
            return;
        }
        const bool is_percent = largest <= 100.0 * largest_of_unit_one;
        if (!is_percent && largest > 1000.0 * largest_of_unit_one)
            return;
        scale_ = is_percent ? "percent" : "permille";
        sentences_.push_back(fmt::format("values up to {:.4g} are probably {}", largest, scale_));
        matrix_.values *= is_percent ? 0.01 : 0.001;
    }

    /// Turns the matrix as its fluorescence says.
    void guess_orientation() {
        evidence_ = evidence_of(matrix_);
        const double share = evidence_.anti_stokes_share();
        const bool is_clear = std::max(share, 1.0 - share) > emission_share;
        if (!table_.rows_are_emission && evidence_.stands_out && is_clear) {
            rows_ = share < 0.5;
            sentences_.push_back(fmt::format(
                "{:.0f} % of the fluorescence would be anti-Stokes if rows were {}, so probably "
                "--rows {}",
                100.0 * std::max(share, 1.0 - share), *rows_ ? "excitation" : "emission",
                *rows_ ? "emission" : "excitation"));
        }
        if (!rows_are_emission())
            evidence_ = evidence_of(matrix_ = exchanged(matrix_));
    }

    void guess_quantity() {
        if (table_.quantity || !evidence_.stands_out || !(table_.rows_are_emission || rows_))
            return;
        const double per_band = evidence_.photons;
        const double density = per_band * matrix_.excitation.step_nm;
        if (has_usual_photons(per_band) == has_usual_photons(density))
            return;
        quantity_ =
            has_usual_photons(per_band) ? MatrixQuantity::PerBand : MatrixQuantity::DensityPerNm;
        sentences_.push_back(fmt::format(
            "an excitation band would have {:.2g} photons re-emitted for each if values were {}, "
            "so probably --quantity {}",
            is_density() ? per_band : density, is_density() ? "per band" : "per nm",
            is_density() ? "density" : "per-band"));
    }

    const UndeclaredTable& table_;
    ReradiationMatrix matrix_;
    MatrixEvidence evidence_;
    std::optional<bool> rows_;
    std::optional<MatrixQuantity> quantity_;
    std::string scale_;
    bool is_noisy_ = false;
    std::vector<std::string> sentences_;
};

} // namespace

void refuse_undeclared_table(const UndeclaredTable& table, const SourcePosition& at) {
    const Guess guess(table);
    const char* const what = table.quantity ? "the orientation of the table is"
                             : table.rows_are_emission
                                 ? "the quantity of the table is"
                                 : "quantity and orientation of the table are";
    const bool is_own_name = table.file == "matrix.csv";
    throw_input_error(
        at, fmt::format("{} not declared{}", what, guess.sentence()),
        fmt::format("write a matrix that says so by `reradiant convert {} {} {}`{}, or "
                    "add above the table {}",
                    quoted(table.file), is_own_name ? "declared.csv" : "matrix.csv",
                    guess.options(), guess.doubt(), guess.lines()));
}

} // namespace reradiant
