// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/tool/tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::tool::contact;
using cam::tool::cutter_height_mm;
using cam::tool::Shape;
using cam::tool::Tool;
using decomp::Angle;

Tool made(Shape shape, double diameter_mm) {
    Tool tool;
    tool.shape = shape;
    tool.diameter_mm = diameter_mm;
    return tool;
}

Tool flat() { return made(Shape::Flat, 6); }

Tool ball() { return made(Shape::Ball, 6); }

Tool bull() {
    Tool tool = made(Shape::BullNose, 6);
    tool.corner_radius_mm = 1;
    return tool;
}

Tool tapered() {
    Tool tool = made(Shape::TaperedBall, 4);
    tool.tip_diameter_mm = 2;
    tool.taper = Angle::degrees(10);
    return tool;
}

Tool vee() {
    Tool tool = made(Shape::V, 6);
    tool.tip_diameter_mm = 0.2;
    tool.point = Angle::degrees(60);
    return tool;
}

Tool drill() {
    Tool tool = made(Shape::Drill, 5);
    tool.point = Angle::degrees(118);
    return tool;
}

std::vector<Tool> all() { return {flat(), ball(), bull(), tapered(), vee(), drill()}; }

TEST(Tool, EachShapeHasItsClosedForm) {
    EXPECT_EQ(cutter_height_mm(flat(), 3), 0);
    EXPECT_DOUBLE_EQ(*cutter_height_mm(ball(), 3), 3);
    EXPECT_NEAR(*cutter_height_mm(ball(), 1.8), 3 - 2.4, 1e-12);
    EXPECT_EQ(cutter_height_mm(bull(), 2), 0);
    EXPECT_NEAR(*cutter_height_mm(bull(), 2.6), 1 - 0.8, 1e-12);
    EXPECT_NEAR(*cutter_height_mm(vee(), 3), 2.9 / std::tan(std::numbers::pi / 6), 1e-12);
    EXPECT_NEAR(*cutter_height_mm(drill(), 2.5), 2.5 / std::tan(59 * std::numbers::pi / 180),
                1e-12);
    const double t = 10 * std::numbers::pi / 180;
    const double ball_end = std::cos(t);
    EXPECT_NEAR(*cutter_height_mm(tapered(), ball_end), 1 - std::sin(t), 1e-12);
    EXPECT_NEAR(*cutter_height_mm(tapered(), 2), 1 - std::sin(t) + (2 - ball_end) / std::tan(t),
                1e-12);
}

TEST(Tool, TheCuttingSurfaceNeverFallsOutwardsAndEndsAtTheRadius) {
    for (const Tool& tool : all()) {
        double last = 0;
        for (int i = 0; i <= 100; ++i) {
            const auto z = cutter_height_mm(tool, tool.radius_mm() * i / 100);
            ASSERT_TRUE(z) << name_of(tool.shape);
            EXPECT_GE(*z, last) << name_of(tool.shape);
            last = *z;
        }
        EXPECT_FALSE(cutter_height_mm(tool, tool.radius_mm() + 1e-6));
    }
}

TEST(Tool, AtItsContactNoPartOfTheCutterIsBelowTheSlope) {
    for (const Tool& tool : all()) {
        for (int tilt = 0; tilt < 90; tilt += 3) {
            const auto at = contact(tool, Angle::degrees(tilt));
            EXPECT_NEAR(*cutter_height_mm(tool, at.r_mm), at.z_mm, 1e-9);
            // The plane through the contact rises outwards by tan(tilt).
            const double rise = std::tan(tilt * std::numbers::pi / 180);
            for (int i = 0; i <= 60; ++i) {
                const double r = tool.radius_mm() * i / 60;
                EXPECT_GE(*cutter_height_mm(tool, r), at.z_mm + (r - at.r_mm) * rise - 1e-9)
                    << name_of(tool.shape) << " at " << tilt << " degrees, r " << r;
            }
        }
    }
}

TEST(Tool, AWallIsTouchedAtTheWidestPlace) {
    for (const Tool& tool : all()) {
        const auto at = contact(tool, Angle::degrees(90));
        EXPECT_DOUBLE_EQ(at.r_mm, tool.radius_mm());
    }
}

TEST(Tool, ShankAndHolderStandWhereTheyAre) {
    Tool tool = ball();
    tool.shank_diameter_mm = 8;
    tool.flute_mm = 12;
    tool.stickout_mm = 30;
    tool.holder = {{20, 20, 10}, {20, 40, 10}};
    EXPECT_EQ(shank_height_mm(tool, 4, 0), 12);
    EXPECT_FALSE(shank_height_mm(tool, 4.01, 0));
    EXPECT_TRUE(shank_height_mm(tool, 4.01, 0.1));
    EXPECT_EQ(holder_height_mm(tool, 10, 0), 30);
    EXPECT_EQ(holder_height_mm(tool, 10, 1), 29);
    EXPECT_EQ(holder_height_mm(tool, 15, 0), 45);
    EXPECT_FALSE(holder_height_mm(tool, 21, 0.5));
    EXPECT_EQ(reach_radius_mm(tool, 0.1, 1), 21);
}

TEST(Tool, NamesOfShapesReadBack) {
    for (const Tool& tool : all()) {
        EXPECT_EQ(cam::tool::shape_named(name_of(tool.shape)), tool.shape);
    }
    EXPECT_FALSE(cam::tool::shape_named("cube"));
}

TEST(Tool, ContradictionsAreSaidInWords) {
    for (const Tool& tool : all()) {
        EXPECT_TRUE(faults(tool).empty()) << name_of(tool.shape) << ": " << faults(tool).front();
    }
    Tool short_stickout = flat();
    short_stickout.stickout_mm = 10;
    EXPECT_EQ(faults(short_stickout).size(), 1U);
    Tool round = bull();
    round.corner_radius_mm = 3;
    EXPECT_EQ(faults(round).size(), 1U);
    Tool blunt = vee();
    blunt.flute_mm = 2;
    EXPECT_EQ(faults(blunt).size(), 1U);
}

}  // namespace
