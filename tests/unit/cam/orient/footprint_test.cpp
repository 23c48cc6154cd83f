// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/footprint.h"

#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using cam::orient::best_turn;
using cam::orient::convex_hull;
using cam::orient::Turned;
using Points = std::vector<Eigen::Vector2d>;

Points rectangle(double width, double depth, double angle) {
    const Eigen::Vector2d x(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d y(-x.y(), x.x());
    return {-width / 2 * x - depth / 2 * y, width / 2 * x - depth / 2 * y,
            width / 2 * x + depth / 2 * y, -width / 2 * x + depth / 2 * y};
}

TEST(Footprint, TheHullOfAGridIsItsFourCorners) {
    Points grid;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 7; ++j) {
            grid.emplace_back(i, j);
        }
    }
    const Points hull = convex_hull(grid);
    ASSERT_EQ(hull.size(), 4U);
    EXPECT_DOUBLE_EQ(cam::orient::polygon_area(hull), 54);
    EXPECT_TRUE(cam::orient::holds(hull, {1, 1}));
    EXPECT_FALSE(cam::orient::holds(hull, {10, 1}));
}

TEST(Footprint, ATurnedRectangleIsTurnedBackWhereOnlyThatFits) {
    const Turned turned = best_turn(rectangle(90, 40, 0.4), {91, 41});
    EXPECT_TRUE(turned.fits());
    EXPECT_NEAR(turned.angle, 0.4, 1e-9);
    EXPECT_NEAR(turned.size.x(), 90, 1e-9);
}

TEST(Footprint, ALongThinBarFitsOnTheDiagonal) {
    const Turned turned = best_turn(rectangle(130, 4, 0), {100, 100});
    EXPECT_TRUE(turned.fits());
    EXPECT_LT(turned.size.maxCoeff(), 100);
}

TEST(Footprint, WhatFitsStraightStaysStraight) {
    EXPECT_EQ(best_turn(rectangle(50, 30, 0), {100, 100}).angle, 0);
    const Turned upright = best_turn(rectangle(50, 30, 0), {40, 100});
    EXPECT_DOUBLE_EQ(upright.angle, std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(upright.size.x(), 30);
}

TEST(Footprint, NoAngleOfADenseScanBeatsTheExactSearch) {
    decomp::Rng rng(5);
    for (int trial = 0; trial < 20; ++trial) {
        Points points;
        for (int i = 0; i < 12; ++i) {
            const double x = rng.uniform(0, 100);
            points.emplace_back(x, rng.uniform(0, 60));
        }
        const Points hull = convex_hull(points);
        const Eigen::Vector2d room(40, 70);
        const Turned exact = best_turn(hull, room);
        for (int i = 0; i < 720; ++i) {
            const double angle = std::numbers::pi * i / 720;
            const Eigen::Vector2d x(std::cos(angle), std::sin(angle));
            double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
            for (const auto& p : hull) {
                low_x = std::min(low_x, p.dot(x));
                high_x = std::max(high_x, p.dot(x));
                low_y = std::min(low_y, p.y() * x.x() - p.x() * x.y());
                high_y = std::max(high_y, p.y() * x.x() - p.x() * x.y());
            }
            const double wide = high_x - low_x, deep = high_y - low_y;
            const double ratio = std::max(wide / room.x(), deep / room.y());
            if (exact.fits()) {
                // Of the turns that fit the smallest is taken, unturned if that is hardly larger.
                EXPECT_TRUE(ratio > 1 || wide * deep >= exact.size.prod() / 1.02 * (1 - 1e-9));
            } else {
                EXPECT_GE(ratio, exact.ratio * (1 - 1e-9));
            }
        }
    }
}

}  // namespace
