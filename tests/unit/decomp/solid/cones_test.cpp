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
using decomp::solid::ConeSurface;
using decomp::solid::CylinderSurface;
using decomp::solid::EllipseCurve;
using decomp::solid::MadeSolid;
using std::numbers::pi;
using tests::euler;
using tests::farthest_off;
using tests::in_float;
using tests::made;
using tests::turned;

std::vector<ConeSurface> cones_of(const MadeSolid& solid) {
    return tests::surfaces_of<ConeSurface>(solid);
}

/// Radius 10 at z = 0, 4 at z = 12, flat ends.
TriMesh frustum(std::uint32_t around) { return tests::revolved(12, {{4, 12}, {10, 0}}, 0, around); }

/// A round block of radius 20 and height 12 whose hole of radius 3 is countersunk to radius 7 in
/// its upper 4 mm; what goes round has `around` chords.
TriMesh countersunk(std::uint32_t around) {
    const std::vector<std::array<double, 2>> rings{{3, 0}, {3, 8}, {7, 12}, {20, 12}, {20, 0}};
    TriMesh mesh;
    for (const auto& [radius, z] : rings) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double turn = 2 * pi * i / around;
            mesh.points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
        }
    }
    for (std::uint32_t r = 0; r < 5; ++r) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t j = (i + 1) % around;
            const std::uint32_t here = r * around;
            const std::uint32_t next = (r + 1) % 5 * around;
            mesh.triangles.push_back({here + i, next + i, next + j});
            mesh.triangles.push_back({here + i, next + j, here + j});
        }
    }
    return decomp::mesh::volume_mm3(mesh) > 0 ? mesh : tests::flipped(mesh);
}

/// The sector of the frustum from 0 to this angle, with two walls that meet in its axis.
TriMesh sector(double angle, std::uint32_t strips) {
    TriMesh mesh;
    mesh.points = {{0, 0, 0}, {0, 0, 12}};
    for (std::uint32_t i = 0; i <= strips; ++i) {
        const double turn = angle * i / strips;
        mesh.points.emplace_back(10 * std::cos(turn), 10 * std::sin(turn), 0);
        mesh.points.emplace_back(4 * std::cos(turn), 4 * std::sin(turn), 12);
    }
    for (std::uint32_t i = 0; i < strips; ++i) {
        const std::uint32_t low = 2 + 2 * i;
        mesh.triangles.push_back({low, low + 2, low + 3});
        mesh.triangles.push_back({low, low + 3, low + 1});
        mesh.triangles.push_back({0, low + 2, low});
        mesh.triangles.push_back({1, low + 1, low + 3});
    }
    const std::uint32_t last = 2 + 2 * strips;
    mesh.triangles.push_back({0, 2, 3});
    mesh.triangles.push_back({0, 3, 1});
    mesh.triangles.push_back({0, last + 1, last});
    mesh.triangles.push_back({0, 1, last + 1});
    return mesh;
}

TEST(Cones, AFrustumIsOneConeWhicheverWayItLies) {
    for (const std::uint32_t around : {12U, 24U, 64U, 200U}) {
        for (const TriMesh& mesh : {frustum(around), turned(frustum(around))}) {
            ASSERT_TRUE(decomp::mesh::check_topology(mesh).manifold());
            const MadeSolid solid = made(mesh);
            EXPECT_EQ(solid.solid.faces.size(), 3) << around << " chords";
            const auto cones = cones_of(solid);
            ASSERT_EQ(cones.size(), 1) << around << " chords";
            EXPECT_NEAR(cones[0].half_angle, std::atan2(6, 12), 1e-9);
            EXPECT_EQ(solid.report.cones, 1);
            EXPECT_NEAR(solid.report.sagitta_mm,
                        10 * (1 - std::cos(pi / around)) * std::cos(cones[0].half_angle), 1e-6);
            EXPECT_EQ(solid.solid.edges.size(), 3) << "two circles and a seam";
            EXPECT_EQ(euler(solid), 2);
            EXPECT_LE(farthest_off(solid), 1e-9);
        }
    }
}

TEST(Cones, TheApexAndTheSenseAreRight) {
    const MadeSolid peg = made(frustum(24));
    ASSERT_EQ(cones_of(peg).size(), 1);
    EXPECT_NEAR((cones_of(peg)[0].apex - Eigen::Vector3d(0, 0, 20)).norm(), 0, 1e-9);
    EXPECT_NEAR((cones_of(peg)[0].axis - Eigen::Vector3d(0, 0, -1)).norm(), 0, 1e-12);
    for (const auto& face : peg.solid.faces) {
        EXPECT_TRUE(face.outward);
    }
}

TEST(Cones, ACountersunkHoleIsACylinderAndACone) {
    for (const std::uint32_t around : {12U, 24U, 64U}) {
        for (const TriMesh& mesh :
             {countersunk(around), turned(countersunk(around)), in_float(countersunk(around))}) {
            ASSERT_TRUE(decomp::mesh::check_topology(mesh).manifold());
            const MadeSolid block = made(mesh);
            EXPECT_EQ(block.solid.faces.size(), 5) << around << " chords";
            EXPECT_EQ(tests::surfaces_of<CylinderSurface>(block).size(), 2);
            ASSERT_EQ(cones_of(block).size(), 1);
            EXPECT_NEAR(cones_of(block)[0].half_angle, pi / 4, 1e-6);
            EXPECT_EQ(euler(block), 0) << "genus 1";
            EXPECT_LE(farthest_off(block), block.solid.tolerance_mm);
            for (const auto& face : block.solid.faces) {
                EXPECT_EQ(face.outward,
                          !std::holds_alternative<ConeSurface>(face.surface) &&
                              !(std::holds_alternative<CylinderSurface>(face.surface) &&
                                std::get<CylinderSurface>(face.surface).radius_mm < 5));
            }
        }
    }
}

TEST(Cones, APartOfATurnEndsInStraightLines) {
    for (const auto& [angle, strips] :
         {std::pair(pi / 2, 3U), std::pair(pi / 2, 8U), std::pair(pi, 12U), std::pair(1.7, 9U)}) {
        const MadeSolid solid = made(sector(angle, strips));
        // The walls of half a turn are one.
        EXPECT_EQ(solid.solid.faces.size(), angle == pi ? 4 : 5) << angle << " in " << strips;
        EXPECT_EQ(cones_of(solid).size(), 1) << angle << " in " << strips;
        EXPECT_LE(farthest_off(solid), 1e-9);
        EXPECT_EQ(euler(solid), 2);
    }
}

TEST(Cones, AnObliqueEndGivesAnEllipse) {
    // The upper rim's points move along the straight lines of the cone into z = 10 + 0.3 x.
    TriMesh mesh = frustum(48);
    for (Eigen::Vector3d& p : mesh.points) {
        const Eigen::Vector3d from_apex = p - Eigen::Vector3d(0, 0, 20);
        if (p.z() > 6) {
            const double s = -10 / (from_apex.z() - 0.3 * from_apex.x());
            p = Eigen::Vector3d(0, 0, 20) + s * from_apex;
        }
    }
    const MadeSolid solid = made(mesh);
    EXPECT_EQ(solid.solid.faces.size(), 3);
    ASSERT_EQ(cones_of(solid).size(), 1);
    long ellipses = 0;
    for (const auto& edge : solid.solid.edges) {
        const auto* ellipse = std::get_if<EllipseCurve>(&edge.curve);
        if (ellipse != nullptr && !ellipse->circle) {
            ++ellipses;
            // x = (20 - z) / 2 and z = 10 + 0.3 x: at either end of the long axis.
            const double right = 5 / 1.15;
            const double left = -5 / 0.85;
            EXPECT_NEAR(ellipse->major.norm(), (right - left) / 2 * std::hypot(1.0, 0.3), 1e-9);
            EXPECT_GE(ellipse->major.norm(), ellipse->minor.norm());
        }
    }
    EXPECT_EQ(ellipses, 1);
    EXPECT_LE(farthest_off(solid), 1e-9);
}

TEST(Cones, AWallBesideTheAxisCutsAHyperbolaAndIsNoCone) {
    // The strips that the wall y = 3 cuts would end in a hyperbola.
    TriMesh mesh = frustum(48);
    for (Eigen::Vector3d& p : mesh.points) {
        p.y() = std::min(p.y(), 3.0);
    }
    const MadeSolid solid = made(mesh);
    EXPECT_TRUE(cones_of(solid).empty());
    EXPECT_EQ(euler(solid), 2);
}

TEST(Cones, APyramidOfFewSidesStaysAPyramid) {
    for (const std::uint32_t around : {4U, 6U, 8U, 11U}) {
        const MadeSolid solid = made(frustum(around));
        EXPECT_TRUE(cones_of(solid).empty()) << around;
        EXPECT_EQ(solid.solid.faces.size(), 2 + around);
    }
}

TEST(Cones, RoughPointsAreNoCone) {
    std::mt19937 dice(7);
    std::uniform_real_distribution<double> off(-0.05, 0.05);
    TriMesh mesh = frustum(24);
    for (Eigen::Vector3d& p : mesh.points) {
        p += Eigen::Vector3d(off(dice), off(dice), 0);
    }
    EXPECT_TRUE(cones_of(made(mesh)).empty());
}

TEST(Cones, ATwistedTaperIsNoCone) {
    // Every other strip leans more: all touch one cone in turn, none of them the same.
    TriMesh mesh = frustum(24);
    for (std::uint32_t i = 0; i < 24; i += 2) {
        mesh.points[1 + i].x() *= 1.01;
        mesh.points[1 + i].y() *= 1.01;
    }
    EXPECT_TRUE(cones_of(made(mesh)).empty());
}

TEST(Cones, ASlenderTaperIsAConeAndNoCylinder) {
    for (const double taper : {0.05, 0.5}) {
        const MadeSolid solid =
            made(tests::revolved(30, {{10 - taper, 30}, {10, 0}}, 0, 48), {.tolerance_mm = 0.02});
        ASSERT_EQ(cones_of(solid).size(), taper < 0.0524 ? 0 : 1) << taper;
    }
}

TEST(Cones, AChamferBetweenTwoCylindersMeetsBothInCircles) {
    for (const TriMesh& mesh :
         {tests::revolved(30, {{8, 30}, {8, 20}, {12, 18}, {12, 0}}, 0, 32),
          in_float(turned(tests::revolved(30, {{8, 30}, {8, 20}, {12, 18}, {12, 0}}, 0, 32)))}) {
        const MadeSolid solid = made(mesh);
        EXPECT_EQ(solid.solid.faces.size(), 5);
        EXPECT_EQ(solid.report.cylinders, 2);
        EXPECT_EQ(solid.report.cones, 1);
        EXPECT_EQ(euler(solid), 2);
        EXPECT_LE(farthest_off(solid), solid.solid.tolerance_mm);
    }
}

TEST(Cones, ASpikeGoesDownToItsApex) {
    for (const std::uint32_t around : {12U, 40U}) {
        const TriMesh spike = tests::revolved(12, {{5, 0}}, 0, around);
        for (const TriMesh& mesh : {spike, turned(spike), in_float(turned(spike))}) {
            const MadeSolid solid = made(mesh);
            EXPECT_EQ(solid.solid.faces.size(), 2) << around << " chords";
            EXPECT_EQ(solid.report.cones, 1);
            EXPECT_EQ(solid.solid.vertices.size(), 2) << "the apex and one on the rim";
            EXPECT_EQ(solid.solid.edges.size(), 2);
            EXPECT_EQ(euler(solid), 2);
            EXPECT_LE(farthest_off(solid), solid.solid.tolerance_mm);
        }
    }
    EXPECT_EQ(made(tests::revolved(12, {{5, 0}}, 0, 8)).solid.faces.size(), 9) << "a pyramid";
}

TEST(Cones, ADrilledHoleEndsInItsTip) {
    // From (0, 0, 5) out, up the wall of radius 4, over the top and down the outside.
    const MadeSolid block = made(tests::revolved(5, {{4, 7.4}, {4, 20}, {10, 20}, {10, 0}}, 0, 24));
    EXPECT_EQ(block.report.cones, 1);
    EXPECT_EQ(block.report.cylinders, 2);
    EXPECT_EQ(block.solid.faces.size(), 5);
    EXPECT_EQ(euler(block), 2);
    EXPECT_LE(farthest_off(block), 1e-9);
}

TEST(Cones, AnHourglassIsTwoCones) {
    const MadeSolid solid = made(tests::revolved(20, {{8, 20}, {3, 10}, {9, 0}}, 0, 40));
    EXPECT_EQ(solid.solid.faces.size(), 4);
    EXPECT_EQ(solid.report.cones, 2);
    EXPECT_LE(farthest_off(solid), 1e-9);
}

}  // namespace
