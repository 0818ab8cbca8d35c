#include "reradiant/fit.h"

#include "host/base/atomic_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace reradiant {

namespace {

using Vector = Eigen::VectorXd;

constexpr int corrections = 12;

/// Bands from the first to the last value that is not zero, with one zero at each side.
struct Table {
    std::vector<double> nm, value;
};

Table trimmed_table(const WavelengthGrid& grid, const Vector& values) {
    int first = 0, last = grid.count - 1;
    while (first + 1 < last && values(first) <= 0.0 && values(first + 1) <= 0.0)
        ++first;
    while (last - 1 > first && values(last) <= 0.0 && values(last - 1) <= 0.0)
        --last;
    Table table;
    for (int band = first; band <= last; ++band) {
        table.nm.push_back(grid.centre_nm(band));
        table.value.push_back(values(band));
    }
    return table;
}

std::string table_text(const Table& table) {
    return fmt::format("{{ nm = [{}], value = [{:.6g}] }}", fmt::join(table.nm, ", "),
                       fmt::join(table.value, ", "));
}

/// A term as a scene has it: absorbed share times yield, from the energy that leaves untruncated.
struct Term {
    Vector emission;   ///< 1/nm, on the emission bands
    Vector excitation; ///< yield times absorbed share, on the excitation bands
};

Fluorophore fluorophore_of(const Term& term, const FitResult& result) {
    const Table e = trimmed_table(result.matrix.emission, term.emission);
    const Table x = trimmed_table(result.matrix.excitation, term.excitation);
    return {Spectrum::table(x.nm, x.value), Spectrum::table(e.nm, e.value), 1.0};
}

/// Energy that every excitation band emits off the diagonal.
Vector column_sums(const ReradiationMatrix& matrix) {
    return matrix.fluorescent_part().colwise().sum().transpose();
}

/// The excitation of a term such that the scene's integration over cells gives back the sum of
/// every column: the form of scene files divides by the photons above the excitation, which a
/// tabulated curve knows in its own way. A few multiplicative corrections suffice.
Term scene_term(const FitResult& result, Eigen::Index k) {
    Term term{result.emission.value.col(k), result.excitation.value.col(k)};
    ReradiationMatrix alone = result.matrix;
    alone.values = result.emission.value.col(k) * result.excitation.value.col(k).transpose() *
                   result.matrix.excitation.step_nm;
    for (int i = 0; i < alone.excitation.count; ++i)
        for (int o = 0; o < alone.emission.count; ++o)
            if (alone.emission.centre_nm(o) <= alone.excitation.centre_nm(i))
                alone.values(o, i) = 0.0;
    const Vector wanted = column_sums(alone);
    for (Eigen::Index i = 0; i < term.excitation.size(); ++i)
        if (wanted(i) <= 0.0)
            term.excitation(i) = 0.0;
    for (int pass = 0; pass < corrections; ++pass) {
        term.excitation = term.excitation.cwiseMin(1.0);
        const Vector got = column_sums(matrix_from_fluorophores(
            {fluorophore_of(term, result)}, Spectrum{}, alone.emission, alone.excitation));
        for (Eigen::Index i = 0; i < term.excitation.size(); ++i)
            if (got(i) > 0.0)
                term.excitation(i) *= std::min(wanted(i) / got(i), 4.0);
    }
    term.excitation = term.excitation.cwiseMin(1.0);
    return term;
}

Vector diagonal_of(const ReradiationMatrix& matrix) {
    Vector diagonal = Vector::Zero(matrix.excitation.count);
    for (int i = 0; i < matrix.excitation.count; ++i)
        if (const int o = diagonal_row(matrix, i); o >= 0)
            diagonal(i) = matrix.values(o, i);
    return diagonal;
}

/// Returns what the diagonal holds beside the terms' own fluorescence within a cell.
Vector reflectance_beside(const FitResult& result, const std::vector<Term>& terms) {
    std::vector<Fluorophore> fluorophores;
    for (const Term& term : terms)
        fluorophores.push_back(fluorophore_of(term, result));
    const ReradiationMatrix model = matrix_from_fluorophores(
        fluorophores, Spectrum{}, result.matrix.emission, result.matrix.excitation);
    return (diagonal_of(result.matrix) - diagonal_of(model)).cwiseMax(0.0);
}

double largest_difference(const FitResult& result, const std::vector<Term>& terms) {
    std::vector<Fluorophore> fluorophores;
    for (const Term& term : terms)
        fluorophores.push_back(fluorophore_of(term, result));
    const Eigen::MatrixXd scene =
        matrix_from_fluorophores(fluorophores, Spectrum{}, result.matrix.emission,
                                 result.matrix.excitation)
            .fluorescent_part();
    const Eigen::MatrixXd fitted = result.matrix.fluorescent_part();
    const double largest = fitted.maxCoeff();
    return largest > 0.0 ? (scene - fitted).cwiseAbs().maxCoeff() / largest : 0.0;
}

std::string header_text(const FitResult& result) {
    return fmt::format("# Fitted by reradiant: model {}, {} terms, {} bytes.\n"
                       "# `reradiation` may be copied into any substrate of a scene.\n"
                       "[material]\n  [material.substrate]\n  type = \"lambert\"\n",
                       fit_model_name(result.model), result.rank, result.bytes);
}

} // namespace

double write_model_file(const std::filesystem::path& file, const FitResult& result,
                        const std::filesystem::path& matrix_file) {
    std::string text = header_text(result);
    if (result.rank == 0 && result.model != FitModel::Matrix) {
        text += "  reflectance = " +
                table_text(trimmed_table(result.matrix.excitation, diagonal_of(result.matrix))) +
                "\n";
        write_text_atomically(file, text);
        return 0.0;
    }
    if (result.model == FitModel::Matrix) {
        text += fmt::format("  reradiation = {{ file = \"{}\" }}\n", matrix_file.string());
        write_text_atomically(file, text);
        return 0.0;
    }
    std::vector<Term> terms;
    for (Eigen::Index k = 0; k < result.emission.value.cols(); ++k)
        terms.push_back(scene_term(result, k));
    text += "  reradiation.reflectance = " +
            table_text(trimmed_table(result.matrix.excitation, reflectance_beside(result, terms))) +
            "\n";
    for (const Term& term : terms)
        text += fmt::format("  [[material.substrate.reradiation.fluorophores]]\n  excitation = {}\n"
                            "  emission = {}\n  quantum_yield = 1.0\n",
                            table_text(trimmed_table(result.matrix.excitation, term.excitation)),
                            table_text(trimmed_table(result.matrix.emission, term.emission)));
    write_text_atomically(file, text);
    return largest_difference(result, terms);
}

} // namespace reradiant
