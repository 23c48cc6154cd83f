// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/intersect.h"

#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::repair::self_intersections;

TEST(SelfIntersections, ATorusHasNone) {
    EXPECT_TRUE(self_intersections(tests::torus(10, 3, 24, 12), 10).empty());
}

TEST(SelfIntersections, TwoBoxesThatCrossHaveSome) {
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {2, 2, 2}), tests::box({1, 1, 1}, {3, 3, 3}));
    EXPECT_FALSE(self_intersections(mesh, 100).empty());
    EXPECT_EQ(self_intersections(mesh, 1).size(), 1U);
}

TEST(SelfIntersections, BoxesThatShareAnEdgeExactlyOnlyTouch) {
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {1, 1, 1}), tests::box({1, 1, 0}, {2, 2, 1}));
    EXPECT_TRUE(self_intersections(mesh, 10).empty());
}

TEST(SelfIntersections, AnEdgeInTheMiddleOfAFaceCounts) {
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {1, 1, 1}), tests::box({1, 0.2, 0.2}, {2, 0.8, 0.8}));
    EXPECT_FALSE(self_intersections(mesh, 10).empty());
}

TEST(SelfIntersections, ATriangleFoldedFlatOntoItsNeighbourCounts) {
    decomp::mesh::TriMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.2, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(self_intersections(mesh, 10).size(), 1U);
    mesh.points[3].y() = -0.2;
    EXPECT_TRUE(self_intersections(mesh, 10).empty());
}

}  // namespace
