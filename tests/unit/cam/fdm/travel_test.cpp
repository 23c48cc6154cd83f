// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/travel.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "decomp/base/rng.h"
#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::EdgeGrid;
using cam::fdm::TravelMap;
using cam::polygon::Paths;
using Eigen::Vector2d;

constexpr double kWidth = 0.45;

TravelMap map_of(const Paths& slice) { return {slice, kWidth, 1.5 * kWidth}; }

/// Whether a way keeps inside a region all along.
bool stays_inside(const Paths& region, const Vector2d& from, const cam::path::Approach& approach,
                  const Vector2d& to) {
    std::vector<Vector2d> way{from};
    way.insert(way.end(), approach.by.begin(), approach.by.end());
    way.push_back(to);
    Paths lines;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        lines.push_back({cam::polygon::from_mm(way[i]), cam::polygon::from_mm(way[i + 1])});
    }
    double out = 0;
    for (const auto& piece : cam::polygon::lines_outside(lines, region)) {
        out += (cam::polygon::to_mm(piece.back()) - cam::polygon::to_mm(piece.front())).norm();
    }
    return out < 1e-3;
}

TEST(Travel, InsideAConvexPartTheWayIsStraight) {
    const auto approach = map_of({tests::disc(10, 60)}).approach({-8, 1}, {8, -2});
    EXPECT_TRUE(approach.inside);
    EXPECT_TRUE(approach.by.empty());
}

TEST(Travel, RoundAHoleTheWayKeepsToTheShorterSide) {
    const Paths ring = {tests::disc(20, 90), tests::hole(tests::disc(10, 60))};
    const auto approach = map_of(ring).approach({-15, 2}, {15, 2});
    EXPECT_TRUE(approach.inside);
    ASSERT_FALSE(approach.by.empty());
    for (const auto& p : approach.by) {
        EXPECT_GT(p.y(), 0);
        EXPECT_GT(p.norm(), 10);
    }
    EXPECT_TRUE(stays_inside(ring, {-15, 2}, approach, {15, 2}));
}

TEST(Travel, ACombIsGoneRoundByItsBack) {
    //  teeth point up; from the top of one to the top of the other
    const Paths comb =
        cam::polygon::unite({tests::rectangle({0, 0}, {20, 4})},
                            cam::polygon::unite({tests::rectangle({0, 0}, {4, 15})},
                                                {tests::rectangle({16, 0}, {20, 15})}));
    const auto approach = map_of(comb).approach({3.775, 14}, {16.225, 14});
    EXPECT_TRUE(approach.inside);
    ASSERT_GE(approach.by.size(), 2U);
    EXPECT_TRUE(stays_inside(comb, {3.775, 14}, approach, {16.225, 14}));
}

TEST(Travel, BetweenIslandsThereIsNoWayInside) {
    const Paths two = {tests::rectangle({0, 0}, {5, 5}), tests::rectangle({8, 0}, {13, 5})};
    const auto approach = map_of(two).approach({4, 2}, {9, 2});
    EXPECT_FALSE(approach.inside);
    EXPECT_TRUE(approach.by.empty());
}

TEST(Travel, ALongDetourIsNotWorthIt) {
    const Paths gap = cam::polygon::subtract({tests::rectangle({0, 0}, {200, 100})},
                                             {tests::rectangle({99, 5}, {101, 101})});
    EXPECT_FALSE(map_of(gap).approach({98.5, 95}, {101.5, 95}).inside);
    EXPECT_TRUE(map_of(gap).approach({98.5, 12}, {101.5, 12}).inside);
}

TEST(Travel, WaysCalledInsideAreInside) {
    decomp::Rng rng(5);
    int bent = 0;
    for (int k = 0; k < 20; ++k) {
        cam::polygon::Path outer;
        for (int i = 0; i < 24; ++i) {
            const double turn = 2 * std::numbers::pi * i / 24;
            const double r = rng.uniform(6, 20);
            outer.push_back(cam::polygon::from_mm({r * std::cos(turn), r * std::sin(turn)}));
        }
        const Paths star = cam::polygon::region_of({outer, tests::hole(tests::disc(3, 20))});
        const TravelMap map = map_of(star);
        const Paths centres = cam::polygon::offset(star, -kWidth / 2);
        std::vector<Vector2d> ends;
        for (const auto& loop : centres) {
            for (const auto& p : loop) {
                ends.push_back(cam::polygon::to_mm(p));
            }
        }
        for (int i = 0; i < 40; ++i) {
            const Vector2d& a = ends[rng.below(ends.size())];
            const Vector2d& b = ends[rng.below(ends.size())];
            const auto approach = map.approach(a, b);
            if (approach.inside) {
                bent += approach.by.empty() ? 0 : 1;
                EXPECT_TRUE(stays_inside(star, a, approach, b)) << k << " " << i;
            }
        }
    }
    EXPECT_GT(bent, 100);
}

TEST(EdgeGrid, AnswersAsTheRegionItself) {
    decomp::Rng rng(9);
    const Paths region = cam::polygon::region_of(
        {tests::disc(20, 200), tests::hole(tests::disc(7, 5)), tests::rectangle({30, 0}, {31, 1})});
    const EdgeGrid grid(region);
    for (int i = 0; i < 500; ++i) {
        const Vector2d p(rng.uniform(-25, 35), rng.uniform(-25, 25));
        EXPECT_EQ(grid.contains(p), cam::polygon::contains(region, cam::polygon::from_mm(p)));
    }
    const auto met = grid.meetings({-50, 0.1}, {50, 0.1});
    ASSERT_EQ(met.size(), 6U);
    EXPECT_NEAR(met[0].point.at_mm.x(), -20, 0.01);
    EXPECT_NEAR(met[5].point.at_mm.x(), 31, 1e-9);
    const auto near = grid.nearest({22, 0.5}, 6);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->at_mm.x(), 20, 0.01);
    EXPECT_FALSE(grid.nearest({25, 20}, 2));
}

}  // namespace
