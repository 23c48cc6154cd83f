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
    const auto rounded = float_mesh(mesh);
    EXPECT_EQ(rounded.points.size(), mesh.points.size() - 1);
    EXPECT_EQ(rounded.triangles.size(), mesh.triangles.size() - 2);
    EXPECT_TRUE(decomp::mesh::check_topology(rounded).manifold());
}
