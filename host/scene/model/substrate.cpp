#include "host/scene/model/substrate.h"

#include "reradiant/reradiation.h"

namespace reradiant {

Eigen::MatrixXd fluorescence_of(const Substrate& substrate, const WavelengthGrid& cells) {
    if (substrate.matrix)
        return fluorescence_on_cells(*substrate.matrix, cells);
    if (substrate.fluorophores.empty())
        return Eigen::MatrixXd::Zero(cells.count, cells.count);
    return matrix_from_fluorophores(substrate.fluorophores, Spectrum(), cells, cells).values;
}

} // namespace reradiant
