// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/solid/make_solid.h"
#include "tests/support/machined.h"
#include "tests/unit/decomp/solid/made.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

using decomp::mesh::TriMesh;
using decomp::solid::CylinderSurface;
using decomp::solid::MadeSolid;
using decomp::solid::TorusSurface;
using std::numbers::pi;
using tests::euler;
using tests::farthest_off;
using tests::in_float;
using tests::made;
using tests::turned;

std::vector<TorusSurface> tori_of(const MadeSolid& solid) {
    return tests::surfaces_of<TorusSurface>(solid);
}

/// A bar of radius 10 and length 30 whose upper edge is rounded by 4.
TriMesh rounded_bar(std::uint32_t around, int down) {
    std::vector<std::array<double, 2>> profile{{6, 30}};
    for (int i = 1; i <= down; ++i) {
        const double turn = pi / 2 * i / down;
        profile.push_back({6 + 4 * std::sin(turn), 26 + 4 * std::cos(turn)});
    }
    profile.push_back({10, 0});
    return tests::revolved(30, profile, 0, around);
}

/// A stem of radius 5 that runs into a flange of radius 12 by a hollow fillet of radius 3.
TriMesh filleted_stem(std::uint32_t around, int down) {
    std::vector<std::array<double, 2>> profile{{5, 30}};
    for (int i = 0; i <= down; ++i) {
        const double turn = pi / 2 * i / down;
        profile.push_back({8 - 3 * std::cos(turn), 7 - 3 * std::sin(turn)});
    }
    profile.push_back({12, 4});
    profile.push_back({12, 0});
    return tests::revolved(30, profile, 0, around);
}

TEST(Tori, ARoundedEdgeOfABarIsOneTorus) {
    for (const int down : {3, 6, 20}) {
        for (const TriMesh& mesh : {rounded_bar(32, down), turned(rounded_bar(32, down))}) {
            ASSERT_TRUE(decomp::mesh::check_topology(mesh).manifold());
            const MadeSolid bar = made(mesh);
            EXPECT_EQ(bar.solid.faces.size(), 4) << down;
            ASSERT_EQ(tori_of(bar).size(), 1) << down;
            EXPECT_EQ(bar.report.tori, 1);
            EXPECT_EQ(bar.report.cones, 0);
            EXPECT_NEAR(tori_of(bar)[0].major_mm, 6, 1e-8);
            EXPECT_NEAR(tori_of(bar)[0].minor_mm, 4, 1e-8);
            EXPECT_EQ(euler(bar), 2);
            EXPECT_LE(farthest_off(bar), bar.solid.tolerance_mm);
        }
    }
}

TEST(Tori, AHollowFilletLooksInward) {
    const MadeSolid stem = made(filleted_stem(40, 5));
    EXPECT_EQ(stem.solid.faces.size(), 6);
    ASSERT_EQ(tori_of(stem).size(), 1);
    EXPECT_NEAR(tori_of(stem)[0].major_mm, 8, 1e-8);
    EXPECT_NEAR(tori_of(stem)[0].minor_mm, 3, 1e-8);
    for (const auto& face : stem.solid.faces) {
        EXPECT_EQ(face.outward, !std::holds_alternative<TorusSurface>(face.surface));
    }
    EXPECT_LE(farthest_off(stem), stem.solid.tolerance_mm);
}

TEST(Tori, ARoundedPlateHasTheFacesThatItWasDrawnWith) {
    const TriMesh plate = tests::rounded_plate(80, 60, 10, 15, 4, 6, 6);
    ASSERT_TRUE(decomp::mesh::check_topology(plate).manifold());
    for (const TriMesh& mesh : {plate, turned(plate), in_float(plate)}) {
        const MadeSolid solid = made(mesh);
        // Top, bottom, four sides, four corners, four fillets, four rounded corners.
        EXPECT_EQ(solid.solid.faces.size(), 18);
        EXPECT_EQ(solid.report.cylinders, 8);
        EXPECT_EQ(solid.report.tori, 4);
        EXPECT_EQ(euler(solid), 2);
        EXPECT_LE(farthest_off(solid), solid.solid.tolerance_mm);
        EXPECT_LE(solid.solid.tolerance_mm, 2e-5);
    }
}

TEST(Tori, ATurnedPartOfManyConesStaysConesWhereNoCircleFits) {
    // Rims on a parabola.
    std::vector<std::array<double, 2>> profile;
    for (int i = 1; i <= 6; ++i) {
        profile.push_back({4 + 0.2 * i * i, 20 - 2.0 * i});
    }
    profile.push_back({11.2, 0});
    const MadeSolid vase = made(tests::revolved(20, profile, 0, 32));
    EXPECT_TRUE(tori_of(vase).empty());
    EXPECT_EQ(vase.report.cones, 6) << "five bands and the tip";
    EXPECT_EQ(vase.report.cylinders, 1);
}

TEST(Tori, RoughRimsAreNoTorus) {
    std::mt19937 dice(3);
    std::uniform_real_distribution<double> off(-0.03, 0.03);
    TriMesh mesh = rounded_bar(32, 8);
    for (std::uint32_t r = 0; r < 9; ++r) {
        const double wider = 1 + off(dice);
        for (std::uint32_t i = 0; i < 32; ++i) {
            mesh.points[1 + r * 32 + i].x() *= wider;
            mesh.points[1 + r * 32 + i].y() *= wider;
        }
    }
    const MadeSolid bar = made(mesh);
    EXPECT_TRUE(tori_of(bar).empty());
    EXPECT_GE(bar.report.cones, 6);
    EXPECT_LE(farthest_off(bar), 1e-9);
}

TEST(Tori, AWholeRingGoesBackToWhatCanBeBounded) {
    const MadeSolid ring = made(tests::torus(20, 6, 24, 12));
    EXPECT_TRUE(tori_of(ring).empty());
    EXPECT_GT(ring.solid.faces.size(), 8);
    EXPECT_EQ(euler(ring), 0);
    EXPECT_LE(farthest_off(ring), ring.solid.tolerance_mm);
}

}  // namespace
