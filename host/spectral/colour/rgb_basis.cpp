#include "host/spectral/colour/rgb_basis.h"

#include "reradiant/colour.h"

#include <Eigen/LU>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace reradiant {

namespace {

constexpr int NODES = 81; ///< 380 to 780 nm by 5
constexpr int UNKNOWNS = 3 * NODES;
constexpr int ROUNDS = 200;

double node_nm(int node) {
    return 380.0 + 5.0 * node;
}

/// The quadratic form of the spectra's roughness: sum of squared first and second differences.
Eigen::MatrixXd roughness() {
    Eigen::MatrixXd form = Eigen::MatrixXd::Zero(UNKNOWNS, UNKNOWNS);
    const auto add = [&](int first, const std::vector<double>& weights) {
        for (std::size_t a = 0; a < weights.size(); ++a)
            for (std::size_t b = 0; b < weights.size(); ++b)
                form(first + static_cast<int>(a), first + static_cast<int>(b)) +=
                    weights[a] * weights[b];
    };
    for (int p = 0; p < 3; ++p) {
        for (int i = 0; i + 1 < NODES; ++i)
            add(p * NODES + i, {0.1, -0.1});
        for (int i = 0; i + 2 < NODES; ++i)
            add(p * NODES + i, {1.0, -2.0, 1.0});
    }
    return form;
}

/// XYZ (rows) that each node's hat function has under D65, the end nodes holding on outwards.
Eigen::MatrixXd node_weights() {
    const ColourMatching& eye = cie_1931_2_degree();
    const Spectrum light = illuminant("D65");
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(3, NODES);
    for (std::size_t k = 0; k < eye.wavelengths_nm.size(); ++k) {
        const double nm = eye.wavelengths_nm[k];
        const double place = std::clamp((nm - 380.0) / 5.0, 0.0, NODES - 1.0);
        const int node = std::min(static_cast<int>(place), NODES - 2);
        const Eigen::Vector3d xyz = light(nm) * Eigen::Vector3d(eye.x[k], eye.y[k], eye.z[k]);
        weights.col(node) += (node + 1 - place) * xyz;
        weights.col(node + 1) += (place - node) * xyz;
    }
    return weights;
}

/// Rows of the equalities: the three spectra add up to 1 everywhere; those of red and green have
/// the XYZ of their primaries under D65 of the white's luminance (blue follows).
void equalities(Eigen::MatrixXd& rows, Eigen::VectorXd& values) {
    rows = Eigen::MatrixXd::Zero(NODES + 6, UNKNOWNS);
    values = Eigen::VectorXd::Ones(NODES + 6);
    for (int i = 0; i < NODES; ++i)
        for (int p = 0; p < 3; ++p)
            rows(i, p * NODES + i) = 1.0;
    const Eigen::MatrixXd weights = node_weights();
    const Eigen::Vector3d white = weights.rowwise().sum();
    for (int p = 0; p < 2; ++p) {
        std::array<double, 3> rgb{};
        rgb[static_cast<std::size_t>(p)] = 1.0;
        const Xyz primary = linear_srgb_to_xyz(rgb);
        rows.block(NODES + 3 * p, p * NODES, 3, NODES) = weights / white.y();
        values.segment(NODES + 3 * p, 3) << primary[0], primary[1], primary[2];
    }
}

/// Minimum of the quadratic form under equalities and the pinned unknowns = 0; `forces` receives
/// what holds each pinned unknown (positive: it would go negative).
Eigen::VectorXd solve_pinned(const Eigen::MatrixXd& form, const Eigen::MatrixXd& rows,
                             const Eigen::VectorXd& values, const std::vector<bool>& pinned,
                             Eigen::VectorXd& forces) {
    std::vector<int> free;
    for (int i = 0; i < UNKNOWNS; ++i)
        if (!pinned[static_cast<std::size_t>(i)])
            free.push_back(i);
    const Eigen::Index n = static_cast<Eigen::Index>(free.size()), m = rows.rows();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
    system.topLeftCorner(n, n) = form(free, free);
    system.topRightCorner(n, m) = rows(Eigen::all, free).transpose();
    system.bottomLeftCorner(m, n) = rows(Eigen::all, free);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
    right.tail(m) = values;
    const Eigen::VectorXd solution = system.fullPivLu().solve(right);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(UNKNOWNS);
    all(free) = solution.head(n);
    forces = form * all + rows.transpose() * solution.tail(m);
    return all;
}

/// Active-set solution of the smoothest non-negative spectra.
Eigen::VectorXd smoothest() {
    const Eigen::MatrixXd form = roughness();
    Eigen::MatrixXd rows;
    Eigen::VectorXd values, forces;
    equalities(rows, values);
    std::vector<bool> pinned(UNKNOWNS, false);
    for (int round = 0; round < ROUNDS; ++round) {
        const Eigen::VectorXd spectra = solve_pinned(form, rows, values, pinned, forces);
        bool changed = false;
        for (int i = 0; i < UNKNOWNS; ++i) {
            const bool now = pinned[static_cast<std::size_t>(i)];
            const bool next = now ? forces(i) > -1e-12 : spectra(i) < -1e-12;
            changed |= next != now;
            pinned[static_cast<std::size_t>(i)] = next;
        }
        if (!changed)
            return spectra.cwiseMax(0.0);
    }
    throw std::logic_error("the rgb basis did not settle");
}

std::array<Spectrum, 3> make_basis() {
    const Eigen::VectorXd spectra = smoothest();
    std::vector<double> nodes(NODES);
    for (int i = 0; i < NODES; ++i)
        nodes[static_cast<std::size_t>(i)] = node_nm(i);
    std::array<Spectrum, 3> basis;
    for (std::size_t p = 0; p < 3; ++p) {
        const Eigen::VectorXd part = spectra.segment(static_cast<Eigen::Index>(p) * NODES, NODES);
        basis[p] = Spectrum::table(nodes, std::vector<double>(part.begin(), part.end()));
    }
    return basis;
}

} // namespace

const std::array<Spectrum, 3>& rgb_basis() {
    static const std::array<Spectrum, 3> basis = make_basis();
    return basis;
}

} // namespace reradiant
