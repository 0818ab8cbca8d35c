#include "host/layers/walk/walk_throughput.h"

namespace reradiant {

void WalkThroughput::re_radiate(WalkRandom& random) {
    if (start_) {
        draw_band(material_.matrix().col(band_), random.next());
    } else if (material_.is_fluorescent()) {
        const Eigen::MatrixXd sent = full_.size() > 0
                                         ? Eigen::MatrixXd(rows_.matrix().asDiagonal() * full_)
                                         : Eigen::MatrixXd(rows_.matrix().asDiagonal());
        full_.noalias() = material_.matrix() * sent;
        rows_.setOnes();
        largest_full_ = full_.maxCoeff();
    } else {
        rows_ *= material_.matrix().diagonal().array();
    }
}

void WalkThroughput::add_to(WalkTally::Parts& parts, const Eigen::ArrayXd& factor) const {
    if (!reached_ && is_spread_)
        add_slab(parts.slab, factor);
    else if (!reached_)
        add_rows(parts.specular, factor);
    else if (!material_.is_fluorescent())
        add_rows(parts.diffuse.col(0), factor);
    else if (start_)
        parts.diffuse(band_, *start_) += rows_(0) * factor(0);
    else
        parts.diffuse.noalias() += (rows_ * factor).matrix().asDiagonal() * full_;
}

void WalkThroughput::draw_band(const Eigen::Ref<const Eigen::VectorXd>& column, double u) {
    const double total = column.sum();
    rows_ *= total;
    double rest = u * total;
    for (int to = 0; to < material_.bands() && total > 0.0; ++to) {
        if (column(to) > 0.0) {
            band_ = to; // the last possible one where rounding leaves a rest
            rest -= column(to);
            if (rest < 0.0)
                break;
        }
    }
}

} // namespace reradiant
