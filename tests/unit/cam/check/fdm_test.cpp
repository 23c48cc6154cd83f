// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/fdm.h"

#include "decomp/mesh/measure.h"
#include "tests/support/part_shapes.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::check::check_axes;
using cam::check::check_fdm;
using cam::check::FdmOptions;
using cam::check::FdmPose;
using decomp::Angle;
using tests::TriMesh;
using tests::whole;

FdmPose standing(const TriMesh& mesh, const FdmOptions& options = {}) {
    const auto facets = decomp::mesh::measure_facets(mesh);
    return cam::check::check_pose(mesh, facets, decomp::mesh::neighbours(mesh),
                                  -Eigen::Vector3d::UnitZ(), options);
}

// A sphere hangs over where the normal is within 45 degrees of straight down: a cap of area
// (1 - cos 45) / 2 of it.
TEST(CheckFdm, ASphereHangsOverInItsLowestCap) {
    const auto pose = standing(tests::sphere(30, 120, 239));
    EXPECT_NEAR(pose.overhang.by_area_percent, 50 * (1 - std::numbers::sqrt2 / 2), 0.15);
    EXPECT_EQ(pose.bridges.facets, 0U);
}

TEST(CheckFdm, TheSupportAngleIsMeasuredFromTheHorizontal) {
    const auto mesh = tests::sphere(30, 120, 239);
    for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
        FdmOptions options;
        options.support_angle = Angle::degrees(degrees);
        EXPECT_NEAR(standing(mesh, options).overhang.by_area_percent,
                    50 * (1 - std::cos(degrees * std::numbers::pi / 180)), 0.25)
            << degrees;
    }
}

TEST(CheckFdm, AHalfSphereOnItsFlatNeedsNothing) {
    const auto check = check_fdm(whole(tests::half_sphere(30, 96, 48)), {});
    const FdmPose& best = check.poses[check.best];
    EXPECT_NEAR(best.down.z(), -1, 1e-9);
    EXPECT_EQ(best.overhang.facets, 0U);
    EXPECT_NEAR(best.plate.by_area_percent, 100.0 / 3, 0.1);
}

TEST(CheckFdm, AHalfSphereOnItsPoleHangsOverLikeASphere) {
    const auto check = check_axes(tests::half_sphere(30, 96, 120), {});
    // Of the whole surface 3 pi r^2 the cap is (1 - cos 45) 2 pi r^2; the flat looks up.
    EXPECT_NEAR(check[1].overhang.by_area_percent, 200.0 / 3 * (1 - std::numbers::sqrt2 / 2), 0.2);
}

TEST(CheckFdm, ACylinderOnItsSideHangsOverOnAQuarterOfItsMantle) {
    // Facets of 1 degree, edges on the plate; mantle 2 pi r l of 2 pi r l + 2 pi r^2.
    const double r = 10;
    const double l = 40;
    const auto mesh = tests::cylinder_x(r, l, 360);
    const double mantle = l / (l + r);
    const auto pose = standing(mesh);
    EXPECT_NEAR(pose.overhang.by_area_percent + pose.plate.by_area_percent, 100 * mantle / 4, 0.35);
    EXPECT_EQ(check_axes(mesh, {})[2].overhang.facets, 0U);
}

TEST(CheckFdm, AnLLyingDownOrStandingNeedsNothingButUpsideDownItsArmDoes) {
    const auto mesh = tests::el(40, 10, 30);
    const auto check = check_fdm(whole(mesh), {});
    EXPECT_EQ(check.poses[check.best].overhang.facets, 0U);
    const auto poses = check_axes(mesh, {});
    EXPECT_EQ(poses[0].overhang.facets, 0U);
    // Turned over it stands on its leg's end and the arm hangs at one side: no bridge.
    EXPECT_NEAR(poses[1].overhang.area_mm2, (40 - 10) * 10, 1e-6);
    EXPECT_EQ(poses[1].bridges.facets, 0U);
}

TEST(CheckFdm, ATorusLyingFlatHangsOverInItsLowerRing) {
    const double big = 30;
    const double small = 8;
    const auto pose = standing(tests::torus(big, small, 120, 240));
    // The tube's angle from straight down runs through -45 to 45 degrees; the ring's element is
    // (R + r cos) so the cosine's mean vanishes by symmetry: a quarter of the surface.
    EXPECT_NEAR(pose.overhang.by_area_percent + pose.plate.by_area_percent, 25, 0.3);
}

TEST(CheckFdm, ACupUpsideDownBridgesItsFloorWhenItIsNarrow) {
    const auto cup = tests::cup(10, 5, 30, 4, 96);
    const auto poses = check_axes(cup, {});
    EXPECT_EQ(poses[0].overhang.facets, 0U);
    // Upside down the floor of the hole, a disc of radius 5, is a ceiling that rests all around.
    const double disc = std::numbers::pi * 25;
    EXPECT_NEAR(poses[1].overhang.area_mm2, disc, 0.01 * disc);
    EXPECT_NEAR(poses[1].bridges.area_mm2, disc, 0.01 * disc);
    EXPECT_EQ(poses[1].support.facets, 0U);
    FdmOptions short_bridges;
    short_bridges.hanging.longest_bridge_mm = 8;
    const auto strict = check_axes(cup, short_bridges);
    EXPECT_EQ(strict[1].bridges.facets, 0U);
    EXPECT_NEAR(strict[1].support.area_mm2, disc, 0.01 * disc);
}

TEST(CheckFdm, APortalIsABridgeAndAGallowsIsNot) {
    const FdmPose portal = standing(tests::portal(10, 10, 30, 5));
    EXPECT_NEAR(portal.bridges.area_mm2, 10 * 10, 1e-6);
    EXPECT_EQ(portal.support.facets, 0U);
    const FdmPose gallows = check_axes(tests::el(40, 10, 30), {})[1];
    EXPECT_EQ(gallows.bridges.facets, 0U);
    EXPECT_GT(gallows.support.facets, 0U);
}

TEST(CheckFdm, WhatBeginsInTheAirIsAnIsland) {
    // A hook's tip hangs down beside the stem and begins in the air.
    const FdmPose hook = standing(tests::hook(10, 40, 15));
    EXPECT_NEAR(hook.islands.area_mm2, 10 * 10, 1e-6);
    const FdmPose portal = standing(tests::portal(10, 10, 30, 5));
    EXPECT_EQ(portal.islands.facets, 0U);
    FdmOptions coarse;
    coarse.hanging.layer_height_mm = 20;
    EXPECT_EQ(standing(tests::hook(10, 40, 15), coarse).islands.facets, 0U);
}

TEST(CheckFdm, EveryFlatFaceIsTried) {
    const auto check = check_fdm(whole(tests::box({0, 0, 0}, {10, 20, 30})), {});
    EXPECT_EQ(check.poses.size(), 6U);
    for (const FdmPose& pose : check.poses) {
        EXPECT_TRUE(pose.on_flat);
        EXPECT_EQ(pose.overhang.facets, 0U);
    }
}

TEST(CheckFdm, SharesOfOneSurfaceAddUp) {
    const FdmPose pose = standing(tests::hook(10, 40, 15));
    EXPECT_NEAR(pose.support.area_mm2 + pose.bridges.area_mm2, pose.overhang.area_mm2, 1e-9);
    EXPECT_LE(pose.islands.area_mm2, pose.support.area_mm2);
}

}  // namespace
