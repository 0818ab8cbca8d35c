#include "host/measure/row_writer.h"

namespace reradiant {

PossiblePairs possible_pairs(const std::vector<Eigen::MatrixXd>& couplings, int bands,
                             bool is_repeated) {
    const PossiblePairs diagonal = PossiblePairs::Identity(bands, bands);
    PossiblePairs possible = diagonal;
    for (const Eigen::MatrixXd& coupling : couplings)
        if (coupling.size() > 0)
            possible = possible.array() || coupling.array() != 0.0;
    if (possible == diagonal)
        return possible;
    for (int via = 0; is_repeated && via < bands; ++via) // Warshall's transitive closure
        for (int i = 0; i < bands; ++i)
            if (possible(via, i))
                possible.col(i) = possible.col(i).array() || possible.col(via).array();
    for (int i = 0; i < bands; ++i)
        possible.col(i).tail(bands - i).setConstant(true);
    return possible;
}

void RowWriter::add(const MeasureRow& angles, MeasuredPart part, const Eigen::MatrixXd& values,
                    const Eigen::MatrixXd& errors) {
    const int bands = measurement_.bands.count;
    const bool changes_band = values.cols() > 1;
    const auto row = [&](int i, int o, int column) {
        MeasureRow& added = measurement_.rows.emplace_back(angles);
        added.lambda_i_nm = measurement_.bands.centre_nm(i);
        added.lambda_o_nm = measurement_.bands.centre_nm(o);
        added.value = values(o, column);
        added.standard_error = errors.size() > 0 ? errors(o, column) : 0.0;
        added.part = part;
    };
    for (int i = 0; i < bands; ++i) {
        if (!changes_band)
            row(i, i, 0);
        for (int o = 0; changes_band && o < bands; ++o)
            if (possible_(o, i))
                row(i, o, i);
    }
}

void PartRows::add_reflected(const MeasureRow& angles, const PartValues& values,
                             const PartValues& errors) {
    if (!is_sheet_)
        rows_.add(angles, MeasuredPart::Diffuse, values.diffuse, errors.diffuse);
    if (may_spread_)
        rows_.add(angles, MeasuredPart::Slab, values.slab, errors.slab);
    rows_.add(angles, MeasuredPart::Specular, values.specular, errors.specular);
}

void PartRows::add_transmitted(const MeasureRow& angles, const PartValues& values,
                               const PartValues& errors) {
    if (may_spread_)
        rows_.add(angles, MeasuredPart::Transmitted, values.slab, errors.slab);
    rows_.add(angles, MeasuredPart::TransmittedSpecular, values.specular, errors.specular);
}

void PartRows::add_guided(const MeasureRow& angles, const Eigen::MatrixXd& values,
                          const Eigen::MatrixXd& errors) {
    if (values.maxCoeff() > 0.0)
        rows_.add(angles, MeasuredPart::Guided, values, errors);
}

} // namespace reradiant
