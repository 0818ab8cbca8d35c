#include "host/scene/meshes/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

using namespace reradiant;

namespace {

using Polygon = std::vector<Vector3>;

double length(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}
/// Half the sum of the cross products of neighbours: the area of any flat polygon.
double area_of(const Polygon& polygon) {
    Vector3 sum{};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        sum[0] += a[1] * b[2] - a[2] * b[1];
        sum[1] += a[2] * b[0] - a[0] * b[2];
        sum[2] += a[0] * b[1] - a[1] * b[0];
    }
    return 0.5 * length(sum);
}
double area_of_triangles(const Polygon& polygon, const std::vector<std::uint32_t>& triangles) {
    double sum = 0.0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
        sum +=
            area_of({polygon[triangles[i]], polygon[triangles[i + 1]], polygon[triangles[i + 2]]});
    return sum;
}

/// The contract: triangles of the polygon's area. 1e-6 of it, plus what doubles lose.
void expect_cut(const Polygon& polygon, const std::string& what) {
    try {
        const double wanted = area_of(polygon);
        EXPECT_NEAR(area_of_triangles(polygon, triangulate_polygon(polygon)), wanted,
                    1e-6 * wanted + 1e-13)
            << what << " of " << polygon.size() << " corners";
    } catch (const std::invalid_argument& error) {
        ADD_FAILURE() << what << " of " << polygon.size() << " corners " << error.what();
    }
}

std::string refusal(const Polygon& polygon) {
    try {
        triangulate_polygon(polygon);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "was cut";
}

class RandomPolygons : public ::testing::Test {
protected:
    double uniform() { return std::uniform_real_distribution<>(0.0, 1.0)(random_); }
    int corners() { return 3 + static_cast<int>(random_() % 98); }

    /// Seen whole from its centre.
    Polygon star(int count, double smallest_radius) {
        Polygon polygon;
        for (int i = 0; i < count; ++i) {
            const double angle = (i + 0.8 * uniform()) * 2.0 * std::numbers::pi / count;
            const double radius = smallest_radius + uniform();
            polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
        }
        return polygon;
    }
    /// Random points whose crossing edges were undone until none was left.
    Polygon untangled(int count) {
        Polygon p;
        for (int i = 0; i < count; ++i)
            p.push_back({uniform(), uniform(), 0.0});
        const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
            return (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) -
                   (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]);
        };
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < p.size(); ++i)
                for (std::size_t k = i + 2; k < p.size(); ++k) {
                    const std::size_t end = (k + 1) % p.size();
                    if (end == i || turn(i, i + 1, k) * turn(i, i + 1, end) >= 0.0 ||
                        turn(k, end, i) * turn(k, end, i + 1) >= 0.0)
                        continue;
                    std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 p.begin() + static_cast<std::ptrdiff_t>(k) + 1);
                    changed = true;
                }
        }
        return p;
    }
    /// Turned by random angles, with coordinates of single precision.
    Polygon tilted(Polygon polygon) {
        const double a = 6.0 * uniform(), b = 6.0 * uniform();
        for (Vector3& p : polygon) {
            const double x = p[0] * std::cos(a) - p[1] * std::sin(a);
            const double y = p[0] * std::sin(a) + p[1] * std::cos(a);
            p = {static_cast<double>(static_cast<float>(x)),
                 static_cast<double>(static_cast<float>(y * std::cos(b))),
                 static_cast<double>(static_cast<float>(y * std::sin(b)))};
        }
        return polygon;
    }

    std::mt19937 random_{20261129};
};

} // namespace

TEST(Polygon, ConvexOnesAreFansOfTheirFirstCorner) {
    EXPECT_EQ(triangulate_polygon(Polygon{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}),
              (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Polygon, DartStarAndLAreCutToTheirArea) {
    const Polygon dart{{-1, -1, 0}, {0, 0, 0}, {1, -1, 0}, {0, 0.8, 0}};
    const Polygon l{{1, -1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, -1, 0}};
    expect_cut(dart, "dart");
    expect_cut(l, "L");
    EXPECT_NEAR(area_of_triangles(dart, triangulate_polygon(dart)), 0.8, 1e-12);
    EXPECT_NEAR(area_of_triangles(l, triangulate_polygon(l)), 3.0, 1e-12);
}

TEST(Polygon, TrianglesTurnAsThePolygonDoes) {
    Polygon dart{{-1, -1, 0}, {0, 0, 0}, {1, -1, 0}, {0, 0.8, 0}};
    for (const double sign : {1.0, -1.0}) {
        const auto triangles = triangulate_polygon(dart);
        ASSERT_EQ(triangles.size(), 6u);
        for (std::size_t i = 0; i < 6; i += 3) {
            const Vector3 &a = dart[triangles[i]], &b = dart[triangles[i + 1]],
                          &c = dart[triangles[i + 2]];
            EXPECT_GT(sign * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])), 0.0);
        }
        std::reverse(dart.begin(), dart.end());
    }
}

TEST(Polygon, Case70DegenerateOnesHaveNoTrianglesOrThoseOfTheirArea) {
    EXPECT_TRUE(triangulate_polygon(Polygon(5, {1, 2, 3})).empty());
    EXPECT_TRUE(triangulate_polygon(Polygon{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}).empty());
    const Vector3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    for (const Polygon& folded : {Polygon{a, b, c, b}, Polygon{b, c, b, a}, Polygon{c, b, a, b}})
        EXPECT_TRUE(triangulate_polygon(folded).empty());
    expect_cut({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}, "repeats");
    expect_cut({{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}, {0, 1, 0}}, "on lines");
    expect_cut({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 5, 0}, {1, 2, 0}, {0, 2, 0}},
               "a spike outwards");
    expect_cut({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}},
               "two triangles that touch");
}

TEST(Polygon, Case70ThoseThatCrossThemselvesAreRefused) {
    EXPECT_NE(refusal({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).find("cancel"),
              std::string::npos);
    EXPECT_NE(refusal({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 1, 0}}).find("after corners 1 and 3"),
              std::string::npos);
    Polygon pentagram;
    for (int i = 0; i < 5; ++i)
        pentagram.push_back(
            {std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i), 0.0});
    EXPECT_NE(refusal(pentagram).find("crosses itself"), std::string::npos);
    // A loop: everything turns left, and the loop would be covered twice.
    EXPECT_NE(refusal({{0, 0, 0},
                       {4, 0, 0},
                       {4, 4, 0},
                       {1, 4, 0},
                       {1, -1, 0},
                       {2, -1, 0},
                       {2, 1, 0},
                       {0, 1, 0}})
                  .find("crosses itself"),
              std::string::npos);
}

TEST(Polygon, FoldedOnesAreCutByTheirShadowAlongTheMeanNormal) {
    // Two squares at a right angle: along an axis one of them would be a line.
    const Polygon folded{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {0, 0, 0}};
    EXPECT_EQ(triangulate_polygon(folded).size(), 12u);
}

TEST(Polygon, MoreCornersThanCanBeCutInTimeAreRefused) {
    Polygon comb;
    for (int i = 0; i < 30000; ++i)
        comb.push_back({static_cast<double>(i), i % 2 == 0 ? 0.0 : 1.0, 0.0});
    comb.push_back({30000.0, -5.0, 0.0});
    comb.push_back({0.0, -5.0, 0.0});
    EXPECT_NE(refusal(comb).find("too many"), std::string::npos);
}

TEST_F(RandomPolygons, Case70AreaIsKept) {
    for (int trial = 0; trial < 1500; ++trial) {
        const Polygon star = this->star(corners(), 0.1), flat = untangled(corners());
        expect_cut(star, "star");
        expect_cut(tilted(star), "tilted star");
        expect_cut(flat, "untangled polygon");
        expect_cut(tilted(flat), "tilted polygon");
    }
}

TEST_F(RandomPolygons, Case70AreaIsKeptWithRepeatedCornersAndCornersOnEdges) {
    for (int trial = 0; trial < 1500; ++trial) {
        const Polygon plain = untangled(3 + corners() / 2);
        Polygon more;
        for (std::size_t i = 0; i < plain.size(); ++i) {
            const Vector3 &a = plain[i], &b = plain[(i + 1) % plain.size()];
            more.push_back(a);
            if (random_() % 4 == 0)
                more.push_back(a);
            if (random_() % 4 == 0)
                more.push_back({0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.0});
        }
        expect_cut(more, "degenerate polygon");
        expect_cut(tilted(more), "tilted degenerate polygon");
    }
}

TEST_F(RandomPolygons, Case70HolesJoinedByAnEdgeAreLeftOut) {
    for (int trial = 0; trial < 1500; ++trial) {
        // At least eight corners: fewer leave the hole's place outside.
        const Polygon outline = star(8 + corners() / 2, 2.0);
        Polygon hole = star(3 + corners() / 2, 0.1);
        for (Vector3& p : hole)
            p = {0.8 * p[0], 0.8 * p[1], 0.0};
        std::reverse(hole.begin(), hole.end());
        // The hole's outermost corner sees the outline's corner that is nearest to its direction.
        const auto far =
            std::max_element(hole.begin(), hole.end(), [](const Vector3& a, const Vector3& b) {
                return length(a) < length(b);
            });
        std::rotate(hole.begin(), far, hole.end());
        const auto near = std::max_element(
            outline.begin(), outline.end(), [&](const Vector3& a, const Vector3& b) {
                const auto along = [&](const Vector3& p) {
                    return (p[0] * hole[0][0] + p[1] * hole[0][1]) / length(p);
                };
                return along(a) < along(b);
            });
        Polygon polygon(outline.begin(), near + 1);
        polygon.insert(polygon.end(), hole.begin(), hole.end());
        polygon.push_back(hole.front());
        polygon.insert(polygon.end(), near, outline.end());
        expect_cut(polygon, "polygon with a hole");
        expect_cut(tilted(polygon), "tilted polygon with a hole");
    }
}
