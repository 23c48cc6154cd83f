// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace {

using cam::motion::Planner;
using cam::motion::Segment;
using Eigen::Vector4d;

cam::profile::FdmMachine::Motion motion(double jerk) {
    cam::profile::FdmMachine::Motion out;
    out.max_speed_mm_per_s = Vector4d(500, 500, 20, 100);
    out.max_acceleration_mm_per_s2 = Vector4d(5000, 5000, 100, 5000);
    out.jerk_mm_per_s = Vector4d::Constant(jerk);
    return out;
}

double seconds(const cam::profile::FdmMachine::Motion& limits, const std::vector<Vector4d>& deltas,
               double speed = 100, double acceleration = 1000) {
    Planner planner(limits);
    for (const Vector4d& delta : deltas) {
        planner.add({delta, speed, acceleration, 0});
    }
    const std::vector<double> slots = planner.finish();
    return std::accumulate(slots.begin(), slots.end(), 0.0);
}

TEST(Planner, ALongMoveIsATrapezoid) {
    // v/a to speed up and as much to brake; v^2/a of the way is lost in them
    EXPECT_NEAR(seconds(motion(0), {{100, 0, 0, 0}}), 0.1 + 0.1 + (100 - 10) / 100.0, 1e-12);
}

TEST(Planner, AShortMoveIsATriangle) {
    EXPECT_NEAR(seconds(motion(0), {{4, 0, 0, 0}}), 2 * std::sqrt(4 / 1000.0), 1e-12);
}

TEST(Planner, JerkIsTheSpeedAtWhichAMoveStartsAndEnds) {
    EXPECT_NEAR(seconds(motion(10), {{100, 0, 0, 0}}), 0.09 + 0.09 + (100 - 9.9) / 100.0, 1e-12);
}

TEST(Planner, CollinearMovesAreOneMove) {
    const double whole = seconds(motion(0), {{100, 0, 0, 0}});
    EXPECT_NEAR(seconds(motion(0), {{40, 0, 0, 0}, {60, 0, 0, 0}}), whole, 1e-12);
    EXPECT_NEAR(seconds(motion(0), std::vector<Vector4d>(1000, {0.1, 0, 0, 0})), whole, 1e-9);
}

TEST(Planner, ARightAngleIsTakenAtTheJerkOfItsAxes) {
    // each leg: from standstill at 10 to 100 and down to 10 at the corner
    const double leg = 0.09 + 0.09 + (50 - 9.9) / 100.0;
    EXPECT_NEAR(seconds(motion(10), {{50, 0, 0, 0}, {0, 50, 0, 0}}), 2 * leg, 1e-12);
}

TEST(Planner, AReversalIsTakenAtHalfTheJerk) {
    const double from_10_to_100_to_5 =
        0.09 + 0.095 + (50 - (10000 - 100) / 2000.0 - (10000 - 25) / 2000.0) / 100.0;
    EXPECT_NEAR(seconds(motion(10), {{50, 0, 0, 0}, {-50, 0, 0, 0}}), 2 * from_10_to_100_to_5,
                1e-12);
}

TEST(Planner, NoAxisIsAboveItsSpeedOrAcceleration) {
    // Z: 20 mm/s, 100 mm/s^2
    EXPECT_NEAR(seconds(motion(0), {{0, 0, 50, 0}}), 0.2 + 0.2 + (50 - 4) / 20.0, 1e-12);
    // E alone moves at its own length
    EXPECT_NEAR(seconds(motion(0), {{0, 0, 0, -10}}), 0.1 + 0.1, 1e-12);
    // along a slope of 3:4 Z allows 25 mm/s and 125 mm/s^2 of path
    EXPECT_NEAR(seconds(motion(0), {{30, 0, 40, 0}}), 0.2 + 0.2 + (50 - 5) / 25.0, 1e-12);
}

TEST(Planner, BrakesInTimeOverManyShortMoves) {
    // 10 mm in 100 pieces, then a stop: reaches 100 mm/s exactly at its middle
    EXPECT_NEAR(seconds(motion(0), std::vector<Vector4d>(100, {0.1, 0, 0, 0})), 0.2, 1e-9);
}

TEST(Planner, AnAccelerationBoundsWhatAJunctionMayBe) {
    // A fast move after a slow one: the slow one may not be left faster than it is driven.
    Planner planner(motion(0));
    planner.add({{10, 0, 0, 0}, 10, 1000, 0});
    planner.add({{100, 0, 0, 0}, 100, 1000, 1});
    const std::vector<double> slots = planner.finish();
    EXPECT_NEAR(slots[0], 0.01 + (10 - 0.05) / 10, 1e-12);
    EXPECT_NEAR(slots[1], 0.09 + 0.1 + (100 - (10000 - 100) / 2000.0 - 5) / 100, 1e-12);
}

TEST(Planner, WhatLiesBeyondTheLookAheadChangesLittle) {
    // 5000 moves of 0.1 mm are planned in several windows
    const double whole = seconds(motion(0), {{500, 0, 0, 0}});
    EXPECT_NEAR(seconds(motion(0), std::vector<Vector4d>(5000, {0.1, 0, 0, 0})), whole, 1e-6);
}

TEST(Planner, MovesOfNoLengthTakeNoTime) {
    EXPECT_EQ(seconds(motion(5), {{0, 0, 0, 0}}), 0);
    EXPECT_TRUE(Planner(motion(5)).finish().empty());
}

}  // namespace
