// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/cutter/drop_cutter.h"

#include "cam/cutter/surface.h"
#include "tests/support/cutters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using cam::cutter::DropCutter;
using cam::cutter::kFree;
using cam::cutter::Surface;
using cam::tool::outline_of;
using cam::tool::Shape;
using Eigen::Vector2d;
using tests::cutter;

constexpr double kExact = 1e-9;

TEST(DropCutter, EveryToolStandsOnABlock) {
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 7}));
    for (const auto& tool : tests::one_of_each()) {
        EXPECT_NEAR(DropCutter(block, outline_of(tool)).lowest_tip(Vector2d(1, 2)), 7, kExact)
            << tool.name;
    }
}

TEST(DropCutter, AFlatEndFallsOffABlockWhenItsRimHasPassedTheEdge) {
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 7}));
    const DropCutter flat(block, outline_of(cutter(Shape::Flat, 6)));
    EXPECT_NEAR(flat.lowest_tip(Vector2d(12.999, 0)), 7, kExact);
    EXPECT_EQ(flat.lowest_tip(Vector2d(13.001, 0), -2), -2);
    EXPECT_EQ(flat.lowest_tip(Vector2d(40, 0)), kFree);
}

TEST(DropCutter, ABallRollsOverAnEdge) {
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 7}));
    const DropCutter ball(block, outline_of(cutter(Shape::Ball, 6)));
    EXPECT_NEAR(ball.lowest_tip(Vector2d(12, 0)), 7 - (3 - std::sqrt(9.0 - 4.0)), kExact);
}

TEST(DropCutter, ABallOnASlopeTouchesAtItsFlank) {
    // A prism whose top rises 45 degrees along x.
    decomp::mesh::TriMesh ramp = tests::box({-20, -20, -30}, {20, 20, 0});
    for (Eigen::Vector3d& p : ramp.points) {
        p.z() += p.z() == 0 ? p.x() : 0;
    }
    const Surface surface(ramp);
    const DropCutter ball(surface, outline_of(cutter(Shape::Ball, 6)));
    EXPECT_NEAR(ball.lowest_tip(Vector2d(0, 0)), 3 * std::sqrt(2.0) - 3, kExact);
    const DropCutter flat(surface, outline_of(cutter(Shape::Flat, 6)));
    EXPECT_NEAR(flat.lowest_tip(Vector2d(0, 0)), 3, kExact);
}

TEST(DropCutter, AFloorThatIsHighEnoughIsTheAnswer) {
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 7}));
    const DropCutter flat(block, outline_of(cutter(Shape::Flat, 6)));
    EXPECT_EQ(flat.lowest_tip(Vector2d(0, 0), 9), 9);
}

TEST(DropCutter, AGrownToolKeepsItsDistance) {
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 7}));
    const auto flat = outline_of(cutter(Shape::Flat, 6));
    const DropCutter grown(block, cam::tool::grown(flat, 0.5));
    EXPECT_NEAR(grown.lowest_tip(Vector2d(0, 0)), 7.5, kExact);
    EXPECT_NEAR(grown.lowest_tip(Vector2d(13.4, 0)), 7 + std::sqrt(0.25 - 0.16), kExact);
    EXPECT_EQ(grown.lowest_tip(Vector2d(13.6, 0), -1), -1);
}

TEST(DropCutter, AHolderKeepsTheTipUp) {
    auto tool = cutter(Shape::Flat, 6);
    tool.flute_mm = 20;
    tool.stickout_mm = 30;
    tool.holder = {{16, 19, 3}, {19, 19, 12}};
    const Surface block(tests::box({-10, -10, 0}, {10, 10, 50}));
    double tip = kFree;
    for (const auto& outline : cam::tool::body_outlines(tool, 0, 1)) {
        tip = std::max(tip, DropCutter(block, outline).lowest_tip(Vector2d(18.5, 0)));
    }
    EXPECT_NEAR(tip, 50 - 29, kExact);
}

TEST(DropCutter, AnEmptySurfaceHoldsNothing) {
    const Surface nothing{decomp::mesh::TriMesh{}};
    EXPECT_EQ(DropCutter(nothing, outline_of(cutter(Shape::Ball, 6))).lowest_tip(Vector2d(0, 0)),
              kFree);
}

TEST(DropCutter, TheWorkPieceBelowAnOverhangDoesNotCount) {
    // What faces down is in the shadow of what lies above it.
    const Surface table(
        tests::joined(tests::box({-10, -10, 8}, {10, 10, 10}), tests::box({-2, -2, 0}, {2, 2, 5})));
    const DropCutter ball(table, outline_of(cutter(Shape::Ball, 6)));
    EXPECT_NEAR(ball.lowest_tip(Vector2d(0, 0)), 10, kExact);
}

}  // namespace
