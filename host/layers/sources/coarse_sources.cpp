#include "host/layers/sources/coarse_sources.h"

#include <utility>

namespace reradiant {

namespace {

class CoarseSources final : public SourceTransport {
public:
    CoarseSources(std::shared_ptr<const SourceTransport> fine, Eigen::Index cells)
        : fine_(std::move(fine)), cells_(cells) {
        // mean over the halves of what each half of the power does
        const Eigen::MatrixXd rows = means(fine_->exchange());
        exchange_ = means(rows.transpose()).transpose();
        weights_ = means(fine_->weights());
        guided_ = means(fine_->guided());
    }

    Eigen::VectorXd reached(double cos_theta, Side from) const override {
        return means(fine_->reached(cos_theta, from));
    }

protected:
    Eigen::VectorXd integrate_escaped(Side to) const override { return means(fine_->escaped(to)); }

private:
    /// Means over each two rows of cells; what follows them, a substrate's, stays.
    Eigen::MatrixXd means(const Eigen::MatrixXd& fine) const {
        const Eigen::Index half = cells_ / 2, rest = fine.rows() - cells_;
        Eigen::MatrixXd coarse(half + rest, fine.cols());
        for (Eigen::Index cell = 0; cell < half; ++cell)
            coarse.row(cell) = 0.5 * (fine.row(2 * cell) + fine.row(2 * cell + 1));
        coarse.bottomRows(rest) = fine.bottomRows(rest);
        return coarse;
    }

    std::shared_ptr<const SourceTransport> fine_;
    Eigen::Index cells_;
};

} // namespace

StackCells coarser(const StackCells& cells) {
    StackCells halved = cells;
    for (DepthCells& own : halved)
        own.cells_per_octave = own.octaves > 0 ? own.cells_per_octave / 2 : own.cells_per_octave;
    return halved;
}

std::shared_ptr<const SourceTransport> coarse_sources(std::shared_ptr<const SourceTransport> fine,
                                                      Eigen::Index cells) {
    return std::make_shared<CoarseSources>(std::move(fine), cells);
}

} // namespace reradiant
