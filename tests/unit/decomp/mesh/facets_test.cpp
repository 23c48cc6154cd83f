// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/facets.h"

#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

TEST(Facets, AreasSumToTheSurfaceAndNormalsHaveUnitLength) {
    const auto mesh = tests::torus(20, 5, 40, 20);
    const auto facets = decomp::mesh::measure_facets(mesh);
    EXPECT_NEAR(facets.total_mm2, decomp::mesh::area_mm2(mesh), 1e-9);
    for (const auto& unit : facets.unit) {
        EXPECT_NEAR(unit.norm(), 1, 1e-12);
    }
}

TEST(Facets, ATriangleWithoutAreaHasNoNormal) {
    tests::TriMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}};
    const auto facets = decomp::mesh::measure_facets(mesh);
    EXPECT_EQ(facets.unit[0].norm(), 0);
    EXPECT_EQ(facets.area_mm2[0], 0);
}

TEST(Facets, NeighboursAreMutualAndShareTheirEdge) {
    const auto mesh = tests::sphere(10, 12, 7);
    const auto beyond = decomp::mesh::neighbours(mesh);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            ASSERT_GE(beyond[i][corner], 0);
            const auto j = static_cast<std::size_t>(beyond[i][corner]);
            const auto a = mesh.triangles[i][corner];
            const auto b = mesh.triangles[i][(corner + 1) % 3];
            bool found = false;
            for (std::size_t other = 0; other < 3; ++other) {
                found = found ||
                        (mesh.triangles[j][other] == b && mesh.triangles[j][(other + 1) % 3] == a &&
                         beyond[j][other] == static_cast<std::int32_t>(i));
            }
            EXPECT_TRUE(found);
        }
    }
}

TEST(Facets, BordersHaveNoNeighbour) {
    auto mesh = tests::box({0, 0, 0}, {1, 1, 1});
    mesh.triangles.pop_back();
    int borders = 0;
    for (const auto& triangle : decomp::mesh::neighbours(mesh)) {
        for (const auto other : triangle) {
            borders += other < 0 ? 1 : 0;
        }
    }
    EXPECT_EQ(borders, 3);
}

}  // namespace
