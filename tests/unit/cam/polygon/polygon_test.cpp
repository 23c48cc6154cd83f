// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/polygon.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::polygon::Paths;
using cam::polygon::Point;
using tests::disc;
using tests::hole;
using tests::rectangle;

TEST(Polygon, MillimetresRoundToTheNearestNanometreAwayFromZero) {
    EXPECT_EQ(cam::polygon::nanometres(0.0000015), 2);
    EXPECT_EQ(cam::polygon::nanometres(-0.0000015), -2);
    EXPECT_EQ(cam::polygon::to_mm(cam::polygon::from_mm({1.25, -3.5})),
              Eigen::Vector2d(1.25, -3.5));
}

TEST(Polygon, HolesCountNegative) {
    const Paths ring{rectangle({0, 0}, {10, 10}), hole(rectangle({2, 2}, {5, 6}))};
    EXPECT_DOUBLE_EQ(cam::polygon::area_mm2(ring), 100 - 12);
}

TEST(Polygon, ContainsIncludesTheBoundaryAndLeavesOutHoles) {
    const Paths ring{rectangle({0, 0}, {10, 10}), hole(rectangle({2, 2}, {5, 6}))};
    const auto inside = [&](double x, double y) {
        return cam::polygon::contains(ring, cam::polygon::from_mm({x, y}));
    };
    EXPECT_TRUE(inside(1, 1));
    EXPECT_TRUE(inside(10, 10));
    EXPECT_TRUE(inside(0, 5));
    EXPECT_TRUE(inside(2, 3));
    EXPECT_FALSE(inside(3, 3));
    EXPECT_FALSE(inside(11, 5));
}

TEST(Polygon, IslandsInHolesAreIslandsOfTheirOwn) {
    const Paths region{rectangle({0, 0}, {20, 20}), hole(rectangle({2, 2}, {18, 18})),
                       rectangle({4, 4}, {16, 16}), hole(rectangle({6, 6}, {8, 8})),
                       hole(rectangle({10, 10}, {12, 12}))};
    const auto islands = cam::polygon::islands(region);
    ASSERT_EQ(islands.size(), 2U);
    EXPECT_EQ(islands[0].holes.size(), 1U);
    EXPECT_EQ(islands[1].holes.size(), 2U);
    EXPECT_DOUBLE_EQ(cam::polygon::area_mm2(islands[1].loops()), 144 - 8);
}

TEST(Polygon, SimplifyingKeepsWithinTheTolerance) {
    const auto fine = disc(10, 4000);
    const auto coarse = cam::polygon::simplified(fine, 0.01);
    EXPECT_LT(coarse.size(), 140U);
    for (const Point& p : coarse) {
        EXPECT_NEAR(cam::polygon::to_mm(p).norm(), 10, 1e-5);
    }
    // Every chord's sagitta stays under the tolerance, so the area differs by less than perimeter
    // times it.
    EXPECT_NEAR(cam::polygon::area_mm2(coarse), cam::polygon::area_mm2(fine), 63 * 0.01);
}

TEST(Polygon, SimplifyingDropsLoopsOfNoArea) {
    EXPECT_TRUE(cam::polygon::simplified(cam::polygon::Path{{0, 0}, {5, 0}}, 0.01).empty());
    EXPECT_TRUE(cam::polygon::simplified(cam::polygon::Path{{0, 0}, {5, 0}, {9, 0}}, 0.01).empty());
}

TEST(Polygon, TheConvexHullDropsInnerAndCollinearPoints) {
    const auto hull =
        cam::polygon::convex_hull({rectangle({0, 0}, {4, 3}),
                                   {cam::polygon::from_mm({2, 1}), cam::polygon::from_mm({2, 0})}});
    EXPECT_EQ(hull.size(), 4U);
    EXPECT_DOUBLE_EQ(cam::polygon::area_mm2(hull), 12);
}

}  // namespace
