// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/mill3.h"

#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using cam::check::check_mill3;
using cam::check::Mill3Check;
using cam::check::Mill3Options;
using cam::check::Mill3Pose;
using cam::check::Setups;
using cam::tool::Shape;
using cam::tool::Tool;
using tests::TriMesh;
using tests::whole;

Mill3Check checked(const TriMesh& mesh, Setups setups = Setups::One,
                   const std::vector<Tool>& tools = {}) {
    Mill3Options options;
    options.setups = setups;
    options.reach.cell_mm = 0.2;
    options.reach.tolerance_mm = 0.2;
    return check_mill3(whole(mesh), options, tools, {}).value();
}

const Mill3Pose& best(const Mill3Check& check) { return check.poses[check.best]; }

Tool tool(Shape shape, double diameter, double flute, double stickout) {
    Tool out;
    out.shape = shape;
    out.diameter_mm = diameter;
    out.shank_diameter_mm = diameter;
    out.flute_mm = flute;
    out.stickout_mm = stickout;
    out.holder = {{30, 30, 40}};
    return out;
}

TEST(CheckMill3, ASphereShowsHalfOfItself) {
    const auto check = checked(tests::sphere(30, 96, 95));
    EXPECT_NEAR(best(check).undercut.by_area_percent, 50, 0.1);
    EXPECT_NEAR(best(check).unseen.by_area_percent, 50, 0.1);
    EXPECT_FALSE(best(check).flat_base);
    EXPECT_FALSE(best(check).height_field);
}

TEST(CheckMill3, TwoSetUpsSeeAllOfASphereAndOfATorus) {
    EXPECT_EQ(best(checked(tests::sphere(30, 48, 25), Setups::Two)).unseen.facets, 0U);
    const auto torus = checked(tests::torus(30, 8, 60, 30), Setups::Two);
    EXPECT_EQ(best(torus).unseen.facets, 0U);
    EXPECT_NEAR(std::abs(best(torus).direction.z()), 1, 1e-6);
}

TEST(CheckMill3, AHalfSphereIsAHeightFieldOverItsFlat) {
    const auto check = checked(tests::half_sphere(30, 64, 32));
    EXPECT_TRUE(best(check).flat_base);
    EXPECT_TRUE(best(check).height_field);
    EXPECT_NEAR(best(check).direction.z(), 1, 1e-9);
    EXPECT_EQ(best(check).undercut.facets, 0U);
    EXPECT_EQ(best(check).unseen.facets, 0U);
    EXPECT_NEAR(best(check).base.by_area_percent, 100.0 / 3, 0.1);
}

TEST(CheckMill3, AnLIsMilledFromAboveAndItsWallsCount) {
    const auto check = checked(tests::el(40, 10, 30));
    EXPECT_EQ(best(check).unseen.facets, 0U);
    EXPECT_TRUE(best(check).height_field);
}

TEST(CheckMill3, AHookHasAnUndercutAndAShadowBelowIt) {
    // From above: the arm's lower face and the tip's lower face lean over; the foot of nothing is
    // hidden but the walls between stem and tip, which see the sky only past the arm.
    const auto mesh = tests::hook(10, 40, 15);
    Mill3Options options;
    const auto check = check_mill3(whole(mesh), options, {}, {}).value();
    for (const Mill3Pose& pose : check.poses) {
        if (pose.direction.z() > 0.99) {
            EXPECT_NEAR(pose.undercut.area_mm2, 10 * 10 + 10 * 10, 1e-6);
            // and the stem's wall below the arm, the tip's inner wall: 30 x 10 and 15 x 10
            EXPECT_NEAR(pose.unseen.area_mm2, 200 + 300 + 150, 1e-6);
        }
    }
    // Lying on its side it is a prism: nothing is hidden.
    EXPECT_EQ(best(check).unseen.facets, 0U);
}

TEST(CheckMill3, ACylinderStandsOnEitherEndAndHalfOfItIsHiddenOnItsSide) {
    const auto mesh = tests::cylinder_x(10, 40, 90);
    const auto check = checked(mesh);
    EXPECT_EQ(best(check).unseen.facets, 0U);
    EXPECT_NEAR(std::abs(best(check).direction.x()), 1, 1e-9);
    // Without flats to stand on: a capsule-like barrel on its side.
    const auto barrel = tests::lying_along_x(tests::sphere(10, 64, 33));
    EXPECT_NEAR(best(checked(barrel)).undercut.by_area_percent, 50, 0.1);
}

TEST(CheckMill3, ACupIsAHeightFieldThatAThickToolCannotEnter) {
    const double inner = 5;
    const double height = 30;
    const double floor = 10;
    const auto cup = tests::cup(15, inner, height, floor, 96);
    const auto check = checked(cup, Setups::One,
                               {tool(Shape::Flat, 12, 32, 60), tool(Shape::Flat, 4, 32, 60),
                                tool(Shape::Flat, 4, 12, 60), tool(Shape::Flat, 4, 12, 15)});
    EXPECT_EQ(best(check).unseen.facets, 0U);
    EXPECT_TRUE(best(check).height_field);
    const double hole = 2 * std::numbers::pi * inner * (height - floor);
    const double bottom = std::numbers::pi * inner * inner;
    // Too wide for the hole: neither its wall nor its floor is reached.
    EXPECT_NEAR(check.tools[0].unreached.area_mm2, hole + bottom, 0.02 * hole);
    // Narrow and long enough.
    EXPECT_NEAR(check.tools[1].unreached.area_mm2, 0, 0.01 * hole);
    EXPECT_LE(check.tools[1].unreached_cutter.area_mm2, check.tools[1].unreached.area_mm2);
    // Flutes of 12 in a hole of 20: the cutter could, the shank rubs on the wall's upper part only
    // where it must go deeper than its flutes; the floor's middle is still free of the wall.
    EXPECT_NEAR(check.tools[2].unreached_cutter.area_mm2, 0, 0.01 * hole);
    EXPECT_GT(check.tools[2].unreached.area_mm2, 0.2 * hole);
    // Sticking out by 15 it cannot reach the floor at 20 either: the holder meets the rim.
    EXPECT_GE(check.tools[3].unreached.area_mm2, check.tools[2].unreached.area_mm2 + 0.9 * bottom);
}

TEST(CheckMill3, AWallHigherThanTheStickoutIsAHeightFieldAndStillNotMillable) {
    // A step of 60 beside a block as wide as any holder.
    const auto step = tests::prism({{0, 0}, {80, 0}, {80, 10}, {40, 10}, {40, 70}, {0, 70}}, 60);
    const auto check =
        checked(step, Setups::One, {tool(Shape::Flat, 6, 65, 100), tool(Shape::Flat, 6, 22, 30)});
    const auto upright = std::find_if(check.poses.begin(), check.poses.end(),
                                      [](const auto& p) { return p.direction.z() > 0.99; });
    ASSERT_NE(upright, check.poses.end());
    EXPECT_TRUE(upright->height_field);
    const auto facets = decomp::mesh::measure_facets(step);
    const auto& options = Mill3Options{}.reach;
    const auto unreached = [&](const Tool& with) {
        const auto reach =
            cam::check::tool_reach(step, facets, Eigen::Vector3d::UnitZ(), with, options, 0.0)
                .value();
        return cam::check::share_of(
                   facets,
                   [&](std::size_t i) { return facets.unit[i].z() > -0.5 && reach.tool[i] == 0; })
            .area_mm2;
    };
    EXPECT_EQ(unreached(tool(Shape::Flat, 6, 65, 100)), 0);
    EXPECT_GT(unreached(tool(Shape::Flat, 6, 22, 30)), 60 * 30);
}

/// A floor at z = 0, 0 <= x <= length, cut into strips, and a wall of height rise at x = 0; closed
/// below and behind.
TriMesh floor_and_wall(double length, double rise, int strips) {
    std::vector<Eigen::Vector2d> outline{{-20, -10}, {length, -10}};
    for (int i = strips; i >= 0; --i) {
        outline.emplace_back(length * i / strips, 0);
    }
    outline.emplace_back(0, rise);
    outline.emplace_back(-20, rise);
    return tests::prism(outline, 40);
}

TEST(CheckMill3, AFlatEndReachesTheFootOfAWallAndABallLeavesAFillet) {
    const auto mesh = floor_and_wall(30, 15, 60);
    const auto facets = decomp::mesh::measure_facets(mesh);
    // Width of the floor's strip that is not reached, by area over depth.
    const auto strip = [&](const Tool& with) {
        const auto reach =
            cam::check::tool_reach(mesh, facets, Eigen::Vector3d::UnitZ(), with, {}).value();
        return cam::check::share_of(facets,
                                    [&](std::size_t i) {
                                        return facets.unit[i].z() > 0.5 &&
                                               facets.centre[i].z() < 1 && reach.tool[i] == 0;
                                    })
                   .area_mm2 /
               40;
    };
    EXPECT_EQ(strip(tool(Shape::Flat, 6, 30, 60)), 0);
    // A ball of radius R leaves what is more than tol = 0.1 below its fillet: x < R - sqrt(2 R
    // tol).
    EXPECT_NEAR(strip(tool(Shape::Ball, 6, 30, 60)), 3 - std::sqrt(2 * 3 * 0.1), 0.6);
    EXPECT_NEAR(strip(tool(Shape::Ball, 12, 30, 60)), 6 - std::sqrt(2 * 6 * 0.1), 0.6);
}

TEST(CheckMill3, NoToolReachesMoreThanARaySees) {
    const auto mesh = tests::dumbbell(20, 6, 40, 5, 48);
    const auto check = checked(mesh, Setups::One,
                               {tool(Shape::Ball, 1, 30, 80), tool(Shape::Ball, 6, 30, 80),
                                tool(Shape::Flat, 6, 30, 80), tool(Shape::Ball, 6, 30, 32)});
    double last = best(check).unseen.area_mm2 * 0.999;
    for (const std::size_t i : {0U, 1U}) {
        EXPECT_GE(check.tools[i].unreached.area_mm2, last);
        last = check.tools[i].unreached.area_mm2;
    }
    EXPECT_GE(check.tools[3].unreached.area_mm2, check.tools[1].unreached.area_mm2);
}

}  // namespace
