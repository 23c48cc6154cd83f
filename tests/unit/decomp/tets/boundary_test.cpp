// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/boundary.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

namespace {

using namespace decomp;

TEST(Boundary, OfABlockIsItsClosedOutwardSurface) {
    const auto tets = tests::voxel_tets({2, 3, 1}, [](int, int, int) { return true; });
    const auto boundary = tets::boundary_surface(tets.points, tets.tets);
    EXPECT_TRUE(mesh::check_topology(boundary.surface).manifold());
    EXPECT_DOUBLE_EQ(mesh::volume_mm3(boundary.surface), 6.0);
    EXPECT_DOUBLE_EQ(mesh::area_mm2(boundary.surface), 2 * (6.0 + 2.0 + 3.0));
}

TEST(Boundary, OfARingHasGenusOne) {
    const auto tets =
        tests::voxel_tets({3, 3, 1}, [](int i, int j, int) { return i != 1 || j != 1; });
    const auto boundary = tets::boundary_surface(tets.points, tets.tets);
    EXPECT_EQ(mesh::check_topology(boundary.surface).euler_characteristic, 0);
}

TEST(Boundary, FacetsRiseByTetAndBelongToIt) {
    const auto tets = tests::voxel_tets({2, 2, 2}, [](int, int, int) { return true; });
    std::uint32_t last = 0;
    for (const auto& facet : tets::boundary_of(tets.tets)) {
        EXPECT_GE(facet.tet, last);
        last = facet.tet;
        bool found = false;
        for (std::size_t k = 0; k < 4; ++k) {
            found = found || tets::face_of(tets.tets[facet.tet], k) == facet.corners;
        }
        EXPECT_TRUE(found);
    }
}

TEST(Boundary, NeighboursAreMutualAndLackOnlyAtTheBoundary) {
    const auto tets = tests::voxel_tets({2, 2, 1}, [](int, int, int) { return true; });
    const auto neighbours = tets::neighbours_of(tets.tets);
    std::size_t none = 0;
    for (std::size_t t = 0; t < neighbours.size(); ++t) {
        for (const std::int32_t other : neighbours[t]) {
            if (other < 0) {
                ++none;
                continue;
            }
            const auto& back = neighbours[static_cast<std::size_t>(other)];
            EXPECT_NE(std::find(back.begin(), back.end(), static_cast<std::int32_t>(t)),
                      back.end());
        }
    }
    EXPECT_EQ(none, tets::boundary_of(tets.tets).size());
}

}  // namespace
