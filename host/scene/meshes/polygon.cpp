#include "host/scene/meshes/polygon.h"

#include "host/scene/toml/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

namespace reradiant {

namespace {

struct Point {
    double u, v;
    bool operator==(const Point&) const = default;
};

/// Returns twice the area of a triangle, positive when it turns to the left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// Twice the polygon's area along its mean normal; corners count from the first, so that a small
/// polygon far from the origin keeps its digits.
Vector3 newell_normal(std::span<const Vector3> corners) {
    Vector3 sum{};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
            sum[axis] += (corners[i][j] - corners[0][j]) * (corners[i + 1][k] - corners[0][k]) -
                         (corners[i][k] - corners[0][k]) * (corners[i + 1][j] - corners[0][j]);
        }
    return sum;
}

/// Returns the corners moved along the normal into the coordinate plane that it leans to most:
/// corners of a polygon in such a plane keep their coordinates exactly, so that what lies on a line
/// still does.
std::vector<Point> shadow(std::span<const Vector3> corners, const Vector3& normal) {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::fabs(normal[k]) > std::fabs(normal[axis]))
            axis = k;
    std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0.0)
        std::swap(u, v);
    std::vector<Point> points;
    for (const Vector3& corner : corners) {
        const double height = (corner[axis] - corners[0][axis]) / normal[axis];
        points.push_back({corner[u] - corners[0][u] - normal[u] * height,
                          corner[v] - corners[0][v] - normal[v] * height});
    }
    return points;
}

/// Returns true when the triangles of corner 0 with each edge all turn left and lie within half a
/// turn.
bool is_fan(const std::vector<Point>& p) {
    for (std::size_t i = 2; i < p.size(); ++i)
        if (!(turn(p[0], p[i - 1], p[i]) > 0.0 && turn(p[0], p[1], p[i]) > 0.0))
            return false;
    return true;
}

std::vector<std::uint32_t> fan(std::size_t corners) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 2; i < corners; ++i)
        triangles.insert(triangles.end(), {0, i - 1, i});
    return triangles;
}

/// Takes ears from a ring of corners until nothing is left. Of any set of triangles that close the
/// ring, those that all turn left cover each place as often as the ring winds around it, so turning
/// left is all that an ear is checked for besides keeping the rest in order.
class EarClipper {
public:
    /// `noise` is the distance by which the points may be off their places.
    EarClipper(std::vector<Point> points, double noise)
        : p_(std::move(points)), left_(p_.size()), noise_(noise) {
        for (std::uint32_t i = 0; i < left_; ++i) {
            before_.push_back(i == 0 ? static_cast<std::uint32_t>(left_) - 1 : i - 1);
            after_.push_back(i + 1 == left_ ? 0 : i + 1);
        }
    }

    std::vector<std::uint32_t> clip();

private:
    enum class Pass { Strict, Flat, Touching };

    /// Returns 1 where a, b, c turn to the left, -1 to the right, 0 where rounding may say either.
    int side(const Point& a, const Point& b, const Point& c) const {
        const double turned = turn(a, b, c);
        const double unsure = noise_ * (std::fabs(b.u - a.u) + std::fabs(b.v - a.v) +
                                        std::fabs(c.u - a.u) + std::fabs(c.v - a.v));
        return turned > unsure ? 1 : turned < -unsure ? -1 : 0;
    }
    double turn_at(std::uint32_t i) const { return turn(p_[before_[i]], p_[i], p_[after_[i]]); }
    int side_at(std::uint32_t i) const { return side(p_[before_[i]], p_[i], p_[after_[i]]); }
    void refuse_crossings();
    std::uint32_t drop_repeats();
    std::optional<std::uint32_t> find(Pass pass, std::uint32_t start);
    bool can_go(Pass pass, std::uint32_t i);
    bool holds(std::uint32_t tip, std::uint32_t other, int least) const;
    void remove(std::uint32_t i);
    void spend(std::size_t steps);
    void check_area() const;

    static constexpr std::size_t most_steps = 100'000'000;

    std::vector<Point> p_;
    std::vector<std::uint32_t> before_, after_;
    std::size_t left_, steps_ = 0;
    double noise_;
    std::vector<std::uint32_t> triangles_;
};

void EarClipper::spend(std::size_t steps) {
    steps_ += steps;
    if (steps_ > most_steps)
        throw std::invalid_argument(
            fmt::format("has {} corners, too many for one that is not convex", p_.size()));
}

/// Refuses edges that cross by more than rounding. This is checked before any ear is cut, because
/// to the ears an outline that winds twice around a place looks in order.
void EarClipper::refuse_crossings() {
    const auto next = [&](std::size_t i) { return i + 1 == p_.size() ? 0 : i + 1; };
    for (std::size_t i = 0; i < p_.size(); ++i) {
        spend(p_.size() - i);
        const Point &a = p_[i], &b = p_[next(i)];
        for (std::size_t k = i + 2; k < p_.size(); ++k) {
            const Point &c = p_[k], &d = p_[next(k)];
            if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0)
                throw std::invalid_argument(
                    fmt::format("crosses itself: its edges after corners {} and {}", i + 1, k + 1));
        }
    }
}

void EarClipper::remove(std::uint32_t i) {
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
    --left_;
}

/// Leaves one corner of each run of equal ones and returns a corner that stays.
std::uint32_t EarClipper::drop_repeats() {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < p_.size(); ++i)
        if (left_ > 3 && p_[i] == p_[before_[i]])
            remove(i);
        else
            kept = i;
    return kept;
}

/// Returns true when another corner keeps the ear at `tip` from being cut off: it lies in the
/// triangle, or at the tip with an edge that leads into the triangle. `least` says how surely it
/// must lie within each edge of the triangle: 1 is surely within, 0 perhaps on the edge.
bool EarClipper::holds(std::uint32_t tip, std::uint32_t other, int least) const {
    const Point &a = p_[before_[tip]], &b = p_[tip], &c = p_[after_[tip]], &q = p_[other];
    if (q == a || q == c)
        return false;
    const auto is_between = [&](const Point& to) {
        return side(a, b, to) >= least && side(b, c, to) >= least;
    };
    if (q == b)
        return is_between(p_[before_[other]]) || is_between(p_[after_[other]]);
    return is_between(q) && side(c, a, q) >= least;
}

/// Returns true when the ear at corner i may be cut off. Corners that are surely convex are not
/// tested: they hold no ear that others would not.
bool EarClipper::can_go(Pass pass, std::uint32_t i) {
    if (pass == Pass::Flat)
        return side_at(i) == 0;
    if (!(turn_at(i) > 0.0))
        return false;
    spend(left_);
    for (std::uint32_t k = after_[after_[i]]; k != before_[i]; k = after_[k])
        if (side_at(k) <= 0 && holds(i, k, pass == Pass::Strict ? 0 : 1))
            return false;
    return true;
}

std::optional<std::uint32_t> EarClipper::find(Pass pass, std::uint32_t start) {
    std::uint32_t i = start;
    do {
        spend(1);
        if (can_go(pass, i))
            return i;
        i = after_[i];
    } while (i != start);
    return std::nullopt;
}

void EarClipper::check_area() const {
    double wanted = 0.0, cut = 0.0;
    for (std::size_t i = 2; i < p_.size(); ++i)
        wanted += turn(p_[0], p_[i - 1], p_[i]);
    for (std::size_t i = 0; i < triangles_.size(); i += 3)
        cut += std::fabs(turn(p_[triangles_[i]], p_[triangles_[i + 1]], p_[triangles_[i + 2]]));
    if (!(std::fabs(cut - wanted) <= 1e-6 * wanted))
        throw std::invalid_argument("crosses itself where it touches itself");
}

std::vector<std::uint32_t> EarClipper::clip() {
    refuse_crossings();
    std::uint32_t start = drop_repeats();
    while (left_ >= 3) {
        auto found = find(Pass::Strict, start);
        for (const Pass pass : {Pass::Flat, Pass::Touching})
            if (!found)
                found = find(pass, start);
        if (!found)
            throw std::invalid_argument("crosses itself where it touches itself");
        if (turn_at(*found) > 0.0)
            triangles_.insert(triangles_.end(), {before_[*found], *found, after_[*found]});
        start = after_[after_[*found]]; // one corner on: fewer slivers
        remove(*found);
    }
    check_area();
    return std::move(triangles_);
}

/// Returns true when the outline only goes there and back: nothing is left when corners between two
/// equal ones are taken away.
bool is_folded_up(std::span<const Vector3> corners) {
    std::vector<Vector3> way;
    for (const Vector3& corner : corners) {
        if (!way.empty() && way.back() == corner)
            continue;
        if (way.size() > 1 && way[way.size() - 2] == corner)
            way.pop_back();
        else
            way.push_back(corner);
    }
    std::size_t first = 0, last = way.size();
    while (last - first > 2 && (way[first] == way[last - 1] || way[first + 1] == way[last - 1])) {
        last -= way[first] == way[last - 1] ? 1 : 0;
        first += last - first > 2 && way[first + 1] == way[last - 1] ? 1 : 0;
    }
    return last - first <= 2;
}

/// `Spread` says how far the corners reach, and whether they all lie on a line.
struct Spread {
    /// Distance that rounding to single precision may move a corner, with room for projecting.
    double noise = 0.0;
    bool is_line = true;

    explicit Spread(std::span<const Vector3> corners) {
        Vector3 longest{};
        double reach = 0.0;
        for (const Vector3& corner : corners) {
            const Vector3 way = from_first(corners, corner);
            if (vector_length(way) > vector_length(longest))
                longest = way;
            reach = std::max(reach, vector_length(corner));
        }
        noise = 0x1p-22 * reach;
        for (const Vector3& corner : corners)
            is_line =
                is_line && vector_length(vector_cross(longest, from_first(corners, corner))) <=
                               noise * vector_length(longest);
    }

private:
    static Vector3 from_first(std::span<const Vector3> corners, const Vector3& p) {
        return {p[0] - corners[0][0], p[1] - corners[0][1], p[2] - corners[0][2]};
    }
};

} // namespace

std::vector<std::uint32_t> triangulate_polygon(std::span<const Vector3> corners) {
    const Vector3 normal = newell_normal(corners);
    const bool has_area = vector_length(normal) > 0.0;
    std::vector<Point> points;
    if (has_area)
        points = shadow(corners, normal);
    if (has_area && is_fan(points))
        return fan(corners.size());
    const Spread spread(corners);
    if (spread.is_line)
        return {};
    if (!has_area && is_folded_up(corners))
        return {};
    if (!has_area)
        throw std::invalid_argument("crosses itself: its parts cancel");
    return EarClipper(std::move(points), spread.noise).clip();
}

} // namespace reradiant
