// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/make_solid.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/machined.h"
#include "tests/unit/decomp/solid/made.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using decomp::mesh::TriMesh;
using decomp::solid::CylinderSurface;
using decomp::solid::Detail;
using decomp::solid::EllipseCurve;
using decomp::solid::MadeSolid;
using tests::euler;
using tests::farthest_off;
using tests::made;

std::vector<CylinderSurface> cylinders_of(const MadeSolid& solid) {
    return tests::surfaces_of<CylinderSurface>(solid);
}

TEST(Solid, ABoxHasSixFacesAndTwelveEdges) {
    const MadeSolid box = made(tests::box({0, 0, 0}, {10, 20, 30}));
    EXPECT_EQ(box.solid.faces.size(), 6);
    EXPECT_EQ(box.solid.edges.size(), 12);
    EXPECT_EQ(box.solid.vertices.size(), 8);
    EXPECT_EQ(box.report.moved_mm, 0);
}

TEST(Solid, AHoleOfManyChordsIsOneCylinder) {
    for (const std::uint32_t around : {12U, 24U, 64U, 200U}) {
        const TriMesh mesh = tests::drilled_plate(40, 30, 10, 6, around);
        ASSERT_TRUE(decomp::mesh::check_topology(mesh).manifold());
        const MadeSolid plate = made(mesh);
        EXPECT_EQ(plate.solid.faces.size(), 7) << around << " chords";
        const auto cylinders = cylinders_of(plate);
        ASSERT_EQ(cylinders.size(), 1) << around << " chords";
        EXPECT_NEAR(cylinders[0].radius_mm, 6, 1e-9);
        EXPECT_NEAR(std::abs(cylinders[0].axis.z()), 1, 1e-12);
        EXPECT_EQ(euler(plate), 0) << "genus 1";
        EXPECT_LE(farthest_off(plate), 1e-9);
        // Sides of the box, two whole circles, a seam.
        EXPECT_EQ(plate.solid.edges.size(), 12 + 2 + 1);
    }
}

TEST(Solid, APrismOfFewSidesStaysAPrism) {
    for (const std::uint32_t around : {4U, 8U}) {
        const MadeSolid plate = made(tests::drilled_plate(40, 30, 10, 6, around));
        EXPECT_TRUE(cylinders_of(plate).empty());
        EXPECT_EQ(plate.solid.faces.size(), 6 + around);
    }
}

TEST(Solid, ARoundBarHasThreeFacesWhicheverWayItLies) {
    const Eigen::Affine3d turned(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) *
                                 Eigen::Translation3d(3, 4, 5));
    const MadeSolid bar = made(decomp::mesh::transformed(tests::round_bar(5, 40, 32), turned));
    EXPECT_EQ(bar.solid.faces.size(), 3);
    const auto cylinders = cylinders_of(bar);
    ASSERT_EQ(cylinders.size(), 1);
    EXPECT_NEAR(cylinders[0].radius_mm, 5, 1e-9);
    EXPECT_NEAR(cylinders[0].axis.cross(turned.linear() * Eigen::Vector3d::UnitZ()).norm(), 0,
                1e-9);
}

TEST(Solid, TheSeamRunsAlongTheSurfaceWhereverItStarts) {
    for (int i = 0; i < 40; ++i) {
        const Eigen::Affine3d turned(
            Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d(i % 3, 2, i % 5).normalized()));
        EXPECT_LE(
            farthest_off(made(decomp::mesh::transformed(tests::round_bar(5, 40, 32), turned))),
            1e-9);
    }
}

TEST(Solid, FloatCoordinatesStillMakeACylinder) {
    TriMesh mesh = tests::drilled_plate(200, 150, 10, 6, 24);
    for (Eigen::Vector3d& p : mesh.points) {
        p = p.cast<float>().cast<double>();
    }
    const MadeSolid plate = made(mesh);
    const auto cylinders = cylinders_of(plate);
    ASSERT_EQ(cylinders.size(), 1);
    EXPECT_NEAR(cylinders[0].radius_mm, 6, 2e-5);
    EXPECT_LE(farthest_off(plate), plate.solid.tolerance_mm);
}

TEST(Solid, AnObliqueEndGivesAnEllipse) {
    // Shear the upper end: points move along the axis, so they stay on the cylinder.
    TriMesh mesh = tests::round_bar(5, 40, 48);
    for (Eigen::Vector3d& p : mesh.points) {
        p.z() += p.z() > 20 ? 0.4 * p.x() : 0;
    }
    const MadeSolid bar = made(mesh);
    EXPECT_EQ(bar.solid.faces.size(), 3);
    long ellipses = 0;
    for (const auto& edge : bar.solid.edges) {
        const auto* ellipse = std::get_if<EllipseCurve>(&edge.curve);
        if (ellipse != nullptr && !ellipse->circle) {
            ++ellipses;
            EXPECT_NEAR(ellipse->minor.norm(), 5, 1e-9);
            EXPECT_NEAR(ellipse->major.norm(), 5 * std::hypot(1.0, 0.4), 1e-9);
        }
    }
    EXPECT_EQ(ellipses, 1);
    EXPECT_LE(farthest_off(bar), 1e-9);
}

TEST(Solid, WithoutDetailEveryTriangleIsAFace) {
    const TriMesh mesh = tests::drilled_plate(40, 30, 10, 6, 24);
    const MadeSolid plate = made(mesh, {.tolerance_mm = 0.02, .detail = Detail::CutsAlone});
    EXPECT_EQ(plate.solid.faces.size(), mesh.triangles.size());
    const MadeSolid flat = made(mesh, {.tolerance_mm = 0.02, .detail = Detail::Flat});
    EXPECT_EQ(flat.solid.faces.size(), 6 + 24);
}

TEST(Solid, CutFacesAreOneFaceEachEvenInOnePlane) {
    decomp::part::Part part{"P01", tests::box({0, 0, 0}, {10, 10, 10}), {}};
    part.sources.resize(part.mesh.triangles.size());
    // The two triangles of the side x = 0: one cut 0, one of the input.
    part.sources[0] = {0, 1};
    const auto solid = decomp::solid::make_solid(part, {}, decomp::Run{});
    ASSERT_TRUE(solid);
    EXPECT_EQ(solid->solid.faces.size(), 7);
}

/// Its sections are ellipses: nothing on it is flat, round or conical.
TriMesh egg(std::uint32_t around, std::uint32_t rings) {
    TriMesh mesh = tests::sphere(20, around, rings);
    for (Eigen::Vector3d& p : mesh.points) {
        p = Eigen::Vector3d(p.x(), 0.8 * p.y() + 0.05 * p.z(), 0.9 * p.z());
    }
    return mesh;
}

TEST(Solid, ManyTrianglesAreJoinedWithinTheTolerance) {
    const TriMesh ball = egg(120, 60);
    const MadeSolid solid = made(ball, {.tolerance_mm = 0.1, .max_faces = 4000});
    EXPECT_LE(solid.solid.faces.size(), 4000);
    EXPECT_GT(solid.report.removed_points, 0);
    EXPECT_LE(solid.report.decimation_mm, 0.1);
    EXPECT_EQ(euler(solid), 2);
}

TEST(Solid, TooManyFacesAreRefusedUnlessForced) {
    const TriMesh ball = egg(60, 30);
    const auto refused = decomp::solid::make_solid(
        {"P01", ball, {}}, {.tolerance_mm = 1e-4, .max_faces = 500}, decomp::Run{});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "solid.too_many_faces");
    const MadeSolid forced = made(ball, {.tolerance_mm = 1e-4, .max_faces = 500, .force = true});
    EXPECT_GT(forced.solid.faces.size(), 500);
}

TEST(Solid, AnOpenMeshIsRefused) {
    TriMesh open = tests::box({0, 0, 0}, {1, 1, 1});
    open.triangles.pop_back();
    const auto solid = decomp::solid::make_solid({"P01", open, {}}, {}, decomp::Run{});
    ASSERT_FALSE(solid);
    EXPECT_EQ(solid.error().code, "solid.not_closed");
}

TEST(Solid, ACavityBelongsToTheShellAroundIt) {
    TriMesh hollow = tests::box({0, 0, 0}, {20, 20, 20});
    TriMesh inner = tests::box({5, 5, 5}, {15, 15, 15});
    for (auto& t : inner.triangles) {
        std::swap(t[1], t[2]);
    }
    const MadeSolid solid =
        made(tests::joined(tests::joined(hollow, inner), tests::box({30, 0, 0}, {40, 10, 10})));
    ASSERT_EQ(solid.solid.shells.size(), 3);
    EXPECT_EQ(solid.solid.cavity_of, (std::vector<std::int32_t>{-1, 0, -1}));
}

}  // namespace
