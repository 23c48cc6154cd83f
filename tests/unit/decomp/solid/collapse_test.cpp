// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/distance.h"
#include "decomp/solid/decimate.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using decomp::mesh::TriMesh;

decomp::solid::Decimated decimated(const TriMesh& mesh, double tolerance_mm,
                                   std::size_t max_faces) {
    const decomp::part::Part part{"P01", mesh, {}};
    const auto adjacency = decomp::solid::adjacency_of(mesh);
    EXPECT_TRUE(adjacency);
    const auto regions = decomp::solid::find_planes(part, *adjacency, {});
    const auto result = decomp::solid::decimate(
        part, *adjacency, regions, {.tolerance_mm = tolerance_mm, .max_faces = max_faces},
        decomp::Run{});
    EXPECT_TRUE(result);
    return *result;
}

/// Half a ball, cut flat at z = 0.
TriMesh dome() {
    TriMesh mesh = tests::sphere(20, 96, 47);
    for (Eigen::Vector3d& p : mesh.points) {
        p.z() = std::max(p.z(), 0.0);
    }
    mesh.points.back() = {0, 0, 0};
    TriMesh out = mesh;
    out.triangles.clear();
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3d normal =
            (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
        EXPECT_GT(normal.norm(), 0);
        out.triangles.push_back(t);
    }
    return out;
}

TEST(Decimate, TheSurfaceStaysClosedAndNear) {
    const TriMesh ball = tests::sphere(20, 120, 60);
    const auto result = decimated(ball, 0.1, 3000);
    EXPECT_LE(result.part.mesh.triangles.size(), 3001);
    EXPECT_TRUE(decomp::mesh::check_topology(result.part.mesh).manifold());
    EXPECT_LE(decomp::repair::farthest_mm(ball, result.part.mesh), 0.1);
    EXPECT_LE(decomp::repair::farthest_mm(result.part.mesh, ball), 0.1);
}

TEST(Decimate, ItStopsWhereTheToleranceEnds) {
    const TriMesh ball = tests::sphere(20, 60, 30);
    const auto result = decimated(ball, 0.02, 10);
    EXPECT_GT(result.part.mesh.triangles.size(), 500);
    EXPECT_LE(result.farthest_mm, 0.02);
}

TEST(Decimate, AFlatFaceKeepsItsPlaneAndItsOutline) {
    const TriMesh cut = dome();
    const auto result = decimated(cut, 0.1, 2000);
    EXPECT_GT(result.removed_points, 0);
    EXPECT_TRUE(decomp::mesh::check_topology(result.part.mesh).manifold());
    double area = 0;
    for (std::size_t t = 0; t < result.part.mesh.triangles.size(); ++t) {
        const Eigen::Vector3d normal = decomp::mesh::double_area_normal(result.part.mesh, t);
        if (normal.z() < -0.999 * normal.norm()) {
            area += normal.norm() / 2;
        }
    }
    // A disc of radius 20, give or take the tolerance along its rim.
    EXPECT_NEAR(area, M_PI * 400, 0.15 * 2 * M_PI * 20);
}

TEST(Decimate, TheSameMeshGivesTheSameTriangles) {
    const TriMesh ball = tests::sphere(20, 60, 30);
    EXPECT_EQ(decimated(ball, 0.2, 1000).part.mesh.triangles,
              decimated(ball, 0.2, 1000).part.mesh.triangles);
}

}  // namespace
