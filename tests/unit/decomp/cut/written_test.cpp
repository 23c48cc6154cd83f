// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/decomp/cut/support.h"

using decomp::cut::check_written;
using decomp::cut::float_mesh;
using tests::box;

TEST(Written, SoundShapesPass) {
    EXPECT_TRUE(check_written(box({0, 0, 0}, {1, 1, 1})).sound());
    EXPECT_TRUE(check_written(tests::torus(10, 3, 48, 24)).sound());
    EXPECT_TRUE(check_written(tests::sphere(10, 40, 19)).sound());
}

TEST(Written, AHoleIsSeen) {
    auto mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.triangles.pop_back();
    EXPECT_FALSE(check_written(mesh).sound());
    EXPECT_EQ(check_written(mesh).topology.border_edges, 3U);
}

TEST(Written, AFlippedTriangleIsSeen) {
    auto mesh = box({0, 0, 0}, {1, 1, 1});
    std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
    EXPECT_FALSE(check_written(mesh).sound());
}

TEST(Written, InsideOutIsSeen) {
    const auto report = check_written(tests::flipped(box({0, 0, 0}, {1, 1, 1})));
    EXPECT_TRUE(report.topology.manifold());
    EXPECT_FALSE(report.outward);
}

TEST(Written, AVertexPushedThroughTheOtherSideIsSeen) {
    auto mesh = tests::sphere(10, 40, 19);
    mesh.points[0].z() = -10.5;
    const auto report = check_written(mesh, 1000);
    EXPECT_TRUE(report.topology.manifold());
    EXPECT_GT(report.intersections.size(), 10U);
}

TEST(Written, OverlapInOnePlaneIsSeen) {
    const auto report = check_written(
        tests::joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0.25, 0.25}, {2, 0.75, 0.75})));
    EXPECT_FALSE(report.intersections.empty());
}

TEST(Written, AFoldOverACommonEdgeIsSeen) {
    auto mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.points[7] = {0.5, 0.5, 1};  // pulls a corner in
    EXPECT_TRUE(check_written(mesh).sound());
    mesh.points[7] = {-0.25, -0.25,
                      1};  // beyond the opposite corner: the top folds over its diagonal
    EXPECT_FALSE(check_written(mesh).sound());
}

TEST(Written, TouchingInCommonPointsIsAllowed) {
    const auto mesh = tests::joined(box({0, 0, 0}, {1, 1, 1}), box({1, 1, 1}, {2, 2, 2}));
    EXPECT_TRUE(check_written(mesh).sound());
}

TEST(Written, AVertexOnAForeignFaceIsSeen) {
    const auto mesh = tests::joined(box({0, 0, 0}, {1, 1, 1}), box({0.25, 0.25, 1}, {0.5, 0.5, 2}));
    EXPECT_FALSE(check_written(mesh).sound());
}

TEST(FloatMesh, PointsThatRoundToOneAreWelded) {
    auto mesh = tests::sphere(10, 40, 19);
    mesh.points[1] = mesh.points[0] + Eigen::Vector3d(0, 0, -1e-9);
    const auto rounded = float_mesh(mesh).mesh;
    EXPECT_EQ(rounded.points.size(), mesh.points.size() - 1);
    EXPECT_EQ(rounded.triangles.size(), mesh.triangles.size() - 2);
    EXPECT_TRUE(decomp::mesh::check_topology(rounded).manifold());
}

TEST(FloatMesh, TrianglesThatLoseTheirAreaAreFlippedAway) {
    // A corner 1e-9 above the middle of an edge: collinear in float.
    auto mesh = box({0, 0, 0}, {2, 1, 1});
    mesh.points.emplace_back(1, 0, -1e-9);
    for (auto& t : mesh.triangles) {  // split the two triangles at the edge 0-4
        t = t == decomp::mesh::Triangle{0, 4, 5} ? decomp::mesh::Triangle{0, 8, 5} : t;
    }
    mesh.triangles.push_back({8, 4, 5});
    mesh.triangles.push_back({0, 4, 8});  // a sliver that is flat after rounding
    EXPECT_TRUE(check_written(mesh).topology.manifold());
    for (auto& p : mesh.points) {
        p.z() += 1;
    }
    const auto rounded = float_mesh(mesh);
    const auto report = check_written(rounded.mesh);
    EXPECT_TRUE(report.sound());
    EXPECT_EQ(report.topology.degenerate_triangles, 0U);
    EXPECT_EQ(rounded.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(rounded.origin.size(), mesh.triangles.size());
}

TEST(FloatMesh, AFinThatFallsFlatIsTakenOut) {
    // A flap of two triangles back to back, 1e-9 apart, on the top of a box.
    auto mesh = box({0, 0, 0}, {1, 1, 1});
    for (auto& t :
         mesh.triangles) {  // the top is (1 5 7), (1 7 3): open the diagonal 1-7 into a fin
        t = t == decomp::mesh::Triangle{1, 7, 3} ? decomp::mesh::Triangle{1, 8, 3} : t;
    }
    mesh.points.emplace_back(0.5, 0.5, 2);
    mesh.triangles.push_back({8, 7, 3});
    mesh.triangles.push_back({1, 7, 8});
    mesh.points.emplace_back(0.5 + 1e-9, 0.5, 2);
    const auto rounded = float_mesh(mesh);
    EXPECT_TRUE(decomp::mesh::check_topology(rounded.mesh).manifold());
    EXPECT_EQ(rounded.mesh.points.size(), 9U);
}

TEST(FloatMesh, AnAllFlatShapeVanishes) {
    const auto rounded = float_mesh(box({1, 1, 1}, {1 + 1e-12, 2, 2}));
    EXPECT_TRUE(rounded.mesh.triangles.empty());
}
