#include "host/layers/sources/flux_section.h"

#include "host/spectral/matrix/linear_systems.h"

#include <utility>

namespace reradiant {

namespace {

/// Flux between two sections after all reflections back and forth, per flux that is put in:
/// up = (I - B A)^-1 with A = above.back_below, B = below.back_above; down = (I - A B)^-1, which is
/// I + A up B.
struct Between {
    Between(const FluxSection& above, const FluxSection& below)
        : up(all_orders(below.back_above * above.back_below)), down_from_up(above.back_below * up),
          down(down_from_up * below.back_above), up_from_down(up * below.back_above) {
        down.diagonal().array() += 1.0;
    }

    static Eigen::MatrixXd all_orders(const Eigen::MatrixXd& round_trip) {
        const Eigen::Index n = round_trip.rows();
        const auto one = Eigen::MatrixXd::Identity(n, n);
        return round_trip.isZero(0.0) ? Eigen::MatrixXd(one) : left_quotient(one - round_trip, one);
    }

    Eigen::MatrixXd up, down_from_up, down, up_from_down;
};

Eigen::MatrixXd stacked(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
    Eigen::MatrixXd both(top.rows() + bottom.rows(), top.cols());
    both << top, bottom;
    return both;
}

/// What the sources of both do to each other.
Eigen::MatrixXd between_all(const FluxSection& above, const FluxSection& below,
                            const Between& inner) {
    const Eigen::Index a = above.sources(), b = below.sources();
    const auto etendue = above.etendue_below.asDiagonal();
    // what each side's sources send into the gap, and what it does there
    const Eigen::MatrixXd sent_down = etendue * above.from_below.transpose();
    const Eigen::MatrixXd sent_up = etendue * below.from_above.transpose();
    Eigen::MatrixXd all(a + b, a + b);
    all.topLeftCorner(a, a) = above.between + above.from_below * (inner.up_from_down * sent_down);
    all.bottomRightCorner(b, b) = below.between + below.from_above * (inner.down_from_up * sent_up);
    all.bottomLeftCorner(b, a) = below.from_above * (inner.down * sent_down);
    all.topRightCorner(a, b) = all.bottomLeftCorner(b, a).transpose();
    return all;
}

} // namespace

FluxSection section_above(const FluxSection& above, const FluxSection& below) {
    const Between inner(above, below);
    const Eigen::MatrixXd down = inner.down * above.down, up = inner.up * below.up;
    const Eigen::MatrixXd returned = inner.up_from_down * above.down;
    const Eigen::MatrixXd returned_below = inner.down_from_up * below.up;
    FluxSection both;
    both.etendue_above = above.etendue_above;
    both.etendue_below = below.etendue_below;
    both.back_above = above.back_above + above.up * returned;
    both.back_below = below.back_below + below.down * returned_below;
    both.down = below.down * down;
    both.up = above.up * up;
    both.from_above =
        stacked(above.from_above + above.from_below * returned, below.from_above * down);
    both.from_below =
        stacked(above.from_below * up, below.from_below + below.from_above * returned_below);
    both.between = between_all(above, below, inner);
    both.guided = stacked(above.guided, below.guided);
    return both;
}

FluxSection upside_down(const FluxSection& section) {
    FluxSection turned = section;
    std::swap(turned.etendue_above, turned.etendue_below);
    std::swap(turned.back_above, turned.back_below);
    std::swap(turned.down, turned.up);
    turned.from_above = section.from_below.colwise().reverse();
    turned.from_below = section.from_above.colwise().reverse();
    turned.between = section.between.reverse();
    turned.guided = section.guided.reverse();
    return turned;
}

Eigen::MatrixXd from_between_down(const FluxSection& above, const FluxSection& below) {
    const Between inner(above, below);
    return stacked(above.from_below * inner.up_from_down, below.from_above * inner.down);
}

Eigen::MatrixXd from_between_up(const FluxSection& above, const FluxSection& below) {
    const Between inner(above, below);
    return stacked(above.from_below * inner.up, below.from_above * inner.down_from_up);
}

} // namespace reradiant
