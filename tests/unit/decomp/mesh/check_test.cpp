// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"

#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::mesh::check_topology;
using decomp::mesh::TopologyReport;

TEST(MeshCheck, ABoxIsOneClosedManifoldOfEulerCharacteristicTwo) {
    const TopologyReport report = check_topology(tests::box({0, 0, 0}, {1, 2, 3}));
    EXPECT_TRUE(report.manifold());
    EXPECT_EQ(report.components, 1U);
    EXPECT_EQ(report.euler_characteristic, 2);
}

TEST(MeshCheck, ATorusHasEulerCharacteristicZero) {
    const TopologyReport report = check_topology(tests::torus(10, 3, 24, 12));
    EXPECT_TRUE(report.manifold());
    EXPECT_EQ(report.euler_characteristic, 0);
}

TEST(MeshCheck, AMissingTriangleOpensThreeBorderEdges) {
    auto mesh = tests::box({0, 0, 0}, {1, 1, 1});
    mesh.triangles.pop_back();
    EXPECT_EQ(check_topology(mesh).border_edges, 3U);
}

TEST(MeshCheck, AFlippedTriangleMisorientsItsThreeEdges) {
    auto mesh = tests::box({0, 0, 0}, {1, 1, 1});
    std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
    EXPECT_EQ(check_topology(mesh).misoriented_edges, 3U);
}

TEST(MeshCheck, TwoBoxesThatShareOnePointMakeANonManifoldVertex) {
    auto mesh = tests::joined(tests::box({0, 0, 0}, {1, 1, 1}), tests::box({1, 1, 1}, {2, 2, 2}));
    for (auto& triangle : mesh.triangles) {
        for (auto& corner : triangle) {
            corner = corner == 8 ? 7 : corner;  // point 8 is (1,1,1) of the second box
        }
    }
    const TopologyReport report = check_topology(mesh);
    EXPECT_EQ(report.non_manifold_vertices, 1U);
    EXPECT_FALSE(report.manifold());
    EXPECT_EQ(report.components, 2U);
}

}  // namespace
