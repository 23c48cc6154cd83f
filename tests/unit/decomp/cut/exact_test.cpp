// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/exact.h"

#include "decomp/base/rng.h"
#include "decomp/cut/ball.h"
#include "decomp/cut/construct.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

using decomp::Rng;
using decomp::cut::Ball;
using decomp::cut::Cells;

namespace {

/// A double of a random magnitude.
double wide(Rng& rng) {
    return std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(80)) - 40);
}

/// An expression with cancellation: the last two terms undo most of the first two.
template <class F>
F expression(const std::array<double, 6>& v) {
    const F first(F(F(v[0]) * F(v[1])) + F(F(v[2]) / F(v[3])));
    const F second(F(v[0] * v[1]) + F(v[2] / v[3]));
    return F(F(first - second) * F(v[4]) + F(F(v[5]) * F(std::ldexp(v[5], -60))));
}

bool is_nearest(double value, const mpq_class& exact) {
    const mpq_class error = abs(mpq_class(value) - exact);
    return error <= abs(mpq_class(std::nextafter(value, HUGE_VAL)) - exact) &&
           error <= abs(mpq_class(std::nextafter(value, -HUGE_VAL)) - exact);
}

/// Random points, one triangle of them, and three planes; vertices of all three implicit kinds.
struct Scene {
    Cells cells;
    std::vector<std::int32_t> vertices;
};

Scene scene(Rng& rng) {
    using Kind = decomp::cut::Line::Kind;
    Scene out;
    auto input = std::make_shared<decomp::mesh::TriMesh>();
    for (int i = 0; i < 4; ++i) {
        input->points.emplace_back(rng.uniform(-10, 10), rng.uniform(-10, 10),
                                   rng.uniform(-10, 10));
    }
    input->triangles = {{0, 1, 2}};
    out.cells.points = input->points;
    out.cells.input = input;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d normal(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
        out.cells.planes.push_back({normal, rng.uniform(-5, 5)});
    }
    out.vertices = {0, 1, 2, 3};
    out.vertices.push_back(out.cells.add_vertex({Kind::InputEdge, 0, 1}, 0));
    out.vertices.push_back(out.cells.add_vertex({Kind::InputEdge, 2, 3}, 1));
    out.vertices.push_back(out.cells.add_vertex({Kind::FacetPlane, 0, 0}, 1));
    out.vertices.push_back(out.cells.add_vertex({Kind::TwoPlanes, 0, 1}, 2));
    return out;
}

mpq_class height(const Cells& cells, std::int32_t vertex, const decomp::part::Plane& plane) {
    using decomp::cut::dot;
    using decomp::cut::exact_point;
    using decomp::cut::vec;
    return dot<mpq_class>(vec<mpq_class>(plane.normal), exact_point<mpq_class>(cells, vertex)) -
           plane.offset_mm;
}

}  // namespace

TEST(Ball, SignIsRightOrOpen) {
    Rng rng(1);
    int decided = 0;
    for (int i = 0; i < 5000; ++i) {
        std::array<double, 6> v{};
        for (double& x : v) {
            x = wide(rng);
        }
        const int sign = expression<Ball>(v).sign();
        decided += sign != 0 ? 1 : 0;
        if (sign != 0) {
            ASSERT_EQ(sign, sgn(expression<mpq_class>(v))) << i;
        }
    }
    EXPECT_GT(decided, 4000);
}

TEST(Ball, RoundsToTheNearestDoubleWhenItSaysSo) {
    Rng rng(2);
    int decided = 0;
    for (int i = 0; i < 5000; ++i) {
        std::array<double, 6> v{};
        for (double& x : v) {
            x = wide(rng);
        }
        const Ball ball = expression<Ball>(v);
        if (ball.rounds_to_high()) {
            ++decided;
            ASSERT_TRUE(is_nearest(ball.high(), expression<mpq_class>(v))) << i;
        }
    }
    EXPECT_GT(decided, 1000);
}

TEST(Ball, DivisionByWhatMayBeZeroDecidesNothing) {
    const Ball zero = Ball(0.1) * Ball(0.1) - Ball(0.1) * Ball(0.1);
    EXPECT_EQ((Ball(1) / zero).sign(), 0);
    EXPECT_FALSE((Ball(1) / zero).rounds_to_high());
    EXPECT_EQ((Ball(1e300) * Ball(1e300)).sign(), 0);  // overflow
}

TEST(Exact, ImplicitVerticesAreRoundedToTheNearestDouble) {
    Rng rng(3);
    for (int i = 0; i < 200; ++i) {
        const Scene s = scene(rng);
        for (const std::int32_t vertex : s.vertices) {
            const auto exact = decomp::cut::exact_point<mpq_class>(s.cells, vertex);
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_TRUE(
                    is_nearest(s.cells.point(vertex)[static_cast<Eigen::Index>(k)], exact[k]));
            }
        }
    }
}

TEST(Exact, ImplicitVerticesLieOnTheirPlanesExactly) {
    Rng rng(4);
    const Scene s = scene(rng);
    EXPECT_EQ(decomp::cut::side_of_plane(s.cells, s.vertices[4], 0), 0);
    EXPECT_EQ(height(s.cells, s.vertices[4], s.cells.planes[0]), 0);
    EXPECT_EQ(height(s.cells, s.vertices[6], s.cells.planes[0]), 0);
    EXPECT_EQ(height(s.cells, s.vertices[6], s.cells.planes[1]), 0);
    for (std::int32_t plane = 0; plane < 3; ++plane) {
        EXPECT_EQ(decomp::cut::side_of_plane(s.cells, s.vertices[7], plane), 0);
        // the same plane, but not known to be one of those that made the vertex
        EXPECT_EQ(decomp::cut::side_of_plane(s.cells, s.vertices[7],
                                             s.cells.planes[static_cast<std::size_t>(plane)]),
                  0);
    }
}

TEST(Exact, SideOfAPlaneAHairAwayIsRight) {
    Rng rng(5);
    for (int i = 0; i < 100; ++i) {
        const Scene s = scene(rng);
        for (const std::int32_t vertex : s.vertices) {
            const Eigen::Vector3d normal(rng.uniform(-1, 1), rng.uniform(-1, 1), 1);
            for (const double hair : {0.0, 1e-15, -1e-15, 1e-12}) {
                const decomp::part::Plane plane{normal, normal.dot(s.cells.point(vertex)) + hair};
                ASSERT_EQ(decomp::cut::side_of_plane(s.cells, vertex, plane),
                          sgn(height(s.cells, vertex, plane)));
            }
        }
    }
}

TEST(Exact, TurnsAndCirclesAgreeWithFractions) {
    using decomp::cut::exact_point;
    Rng rng(6);
    for (int i = 0; i < 100; ++i) {
        const Scene s = scene(rng);
        const auto& v = s.vertices;
        for (std::size_t k = 0; k + 3 < v.size(); ++k) {
            const auto flat = [&](std::size_t j) {
                const auto p = exact_point<mpq_class>(s.cells, v[k + j]);
                const auto o = exact_point<mpq_class>(s.cells, v[k + 3]);
                return std::array<mpq_class, 2>{p[0] - o[0], p[1] - o[1]};
            };
            const auto a = flat(0);
            const auto b = flat(1);
            const auto c = flat(2);
            const mpq_class area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            ASSERT_EQ(decomp::cut::turn(s.cells, {0, 1}, v[k], v[k + 1], v[k + 2]), sgn(area));
            const auto lift = [](const auto& p) { return mpq_class(p[0] * p[0] + p[1] * p[1]); };
            const auto det = [](const auto& p, const auto& q) {
                return mpq_class(p[0] * q[1] - p[1] * q[0]);
            };
            const mpq_class circle =
                lift(a) * det(b, c) + lift(b) * det(c, a) + lift(c) * det(a, b);
            ASSERT_EQ(decomp::cut::in_circle(s.cells, {0, 1}, {v[k], v[k + 1], v[k + 2], v[k + 3]}),
                      sgn(circle));
        }
    }
}

TEST(Exact, CollinearPointsDoNotTurn) {
    auto input = std::make_shared<decomp::mesh::TriMesh>();
    input->points = {{0.1, 0.2, 0}, {0.3, 0.5, 0}, {0.7, 0.1, 0}, {0, 0, 1}};
    input->triangles = {{0, 1, 2}};
    Cells cells;
    cells.points = input->points;
    cells.input = input;
    cells.planes = {{{1, 0.3, 0.2}, 0.3}, {{0.9, 0.25, 0.1}, 0.27}};
    const std::int32_t p = cells.add_vertex({decomp::cut::Line::Kind::InputEdge, 0, 1}, 0);
    const std::int32_t q = cells.add_vertex({decomp::cut::Line::Kind::InputEdge, 0, 1}, 1);
    EXPECT_EQ(decomp::cut::turn(cells, {0, 1}, 0, p, q), 0);
    EXPECT_EQ(decomp::cut::turn(cells, {0, 1}, p, q, 1), 0);
    EXPECT_NE(decomp::cut::turn(cells, {0, 1}, 0, p, 2), 0);
    EXPECT_NE(decomp::cut::lexicographically_less(cells, p, q),
              decomp::cut::lexicographically_less(cells, q, p));
}
