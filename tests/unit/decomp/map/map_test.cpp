// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/map.h"

#include "decomp/map/quantise.h"
#include "decomp/mesh/measure.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/tetrahedralise.h"
#include "tests/support/facing.h"
#include "tests/support/shapes.h"
#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

namespace {

using namespace decomp;

map::MapResult mapped(const mesh::TriMesh& surface) {
    decomp::Run run;
    const auto tets = tets::tetrahedralise(surface, run);
    EXPECT_TRUE(tets.has_value());
    auto result = map::map_to_polycube(*tets, surface, tests::facing(surface), {}, run);
    EXPECT_TRUE(result.has_value()) << result.error().text();
    return *result;
}

/// Every facet lies exactly in a plane of its axis.
void expect_flat_charts(const map::MapResult& result) {
    const auto facets = tets::boundary_of(result.pair.tets);
    ASSERT_EQ(facets.size(), result.labels.size());
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const int axis = labels::axis_of(result.labels[i]);
        const double at = result.pair.polycube[facets[i].corners[0]][axis];
        EXPECT_EQ(result.pair.polycube[facets[i].corners[1]][axis], at);
        EXPECT_EQ(result.pair.polycube[facets[i].corners[2]][axis], at);
    }
}

TEST(Map, ASphereBecomesOneBlock) {
    const auto surface = tests::sphere(10, 32, 17);
    const auto result = mapped(surface);
    EXPECT_EQ(result.measures.flips, 0U);
    EXPECT_LT(result.measures.symmetric_dirichlet, 1.6);
    expect_flat_charts(result);
    const auto lattice = map::quantise(result);
    double volume = 1;
    for (const auto& planes : lattice.planes) {
        ASSERT_EQ(planes.size(), 2U);
        volume *= planes[1] - planes[0];
    }
    EXPECT_NEAR(volume, result.measures.polycube_mm3, 1e-9 * volume);
}

TEST(Map, ATorusBecomesAFrame) {
    const auto result = mapped(tests::torus(10, 4, 48, 24));
    // Single tets may stay flipped at the corners, which zigzag here.
    EXPECT_LT(result.measures.flipped_share, 1e-3);
    EXPECT_GT(result.measures.polycube_mm3, 0.8 * result.measures.volume_mm3);
    expect_flat_charts(result);
    const auto lattice = map::quantise(result);
    ASSERT_EQ(lattice.planes[0].size(), 4U);
    ASSERT_EQ(lattice.planes[1].size(), 4U);
    ASSERT_EQ(lattice.planes[2].size(), 2U);
    // A frame: the whole box less its middle block.
    const auto& p = lattice.planes;
    const double height = p[2][1] - p[2][0];
    const double frame = height * ((p[0][3] - p[0][0]) * (p[1][3] - p[1][0]) -
                                   (p[0][2] - p[0][1]) * (p[1][2] - p[1][1]));
    EXPECT_NEAR(result.measures.polycube_mm3, frame, 1e-9 * frame);
}

TEST(Map, APolycubeStaysAsItIs) {
    const auto tets = tests::voxel_tets(
        {3, 3, 2}, [](int i, int j, int k) { return k == 0 || (i == 1 && j == 1); });
    const auto boundary = tets::boundary_surface(tets.points, tets.tets);
    // The map wants the surface's points first.
    tets::TetMesh ordered{boundary.surface.points, {}};
    std::vector<std::uint32_t> number(tets.points.size(), 0);
    std::vector<char> known(tets.points.size(), 0);
    for (std::uint32_t i = 0; i < boundary.points_from.size(); ++i) {
        number[boundary.points_from[i]] = i;
        known[boundary.points_from[i]] = 1;
    }
    for (std::uint32_t i = 0; i < tets.points.size(); ++i) {
        if (known[i] == 0) {
            number[i] = static_cast<std::uint32_t>(ordered.points.size());
            ordered.points.push_back(tets.points[i]);
        }
    }
    for (tets::Tet tet : tets.tets) {
        for (std::uint32_t& corner : tet) {
            corner = number[corner];
        }
        ordered.tets.push_back(tet);
    }
    decomp::Run run;
    const auto result =
        map::map_to_polycube(ordered, boundary.surface, tests::facing(boundary.surface), {}, run);
    ASSERT_TRUE(result.has_value()) << result.error().text();
    EXPECT_EQ(result->measures.flips, 0U);
    EXPECT_NEAR(result->measures.symmetric_dirichlet, 1, 1e-3);
    EXPECT_NEAR(result->measures.volume_mm3, 10, 1e-9);
    EXPECT_EQ(map::quantise(*result, 0.01).planes[2].size(), 3U);
}

TEST(Map, KeepsTheBitsOfTheSurface) {
    const auto surface = tests::torus(10, 4, 40, 20);
    const auto result = mapped(surface);
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        EXPECT_EQ(result.pair.shape[i], surface.points[i]);
    }
    EXPECT_NEAR(result.measures.volume_mm3, mesh::volume_mm3(surface),
                1e-9 * mesh::volume_mm3(surface));
}

TEST(Map, LabelsOfNoPolycubeEndInFlipsAndDoNotHang) {
    const auto surface = tests::sphere(10, 24, 13);
    decomp::Run run;
    const auto tets = tets::tetrahedralise(surface, run);
    ASSERT_TRUE(tets.has_value());
    const labels::Labeling all(surface.triangles.size(), labels::AxisLabel::PlusX);
    const auto result = map::map_to_polycube(*tets, surface, all, {}, run);
    ASSERT_TRUE(result.has_value()) << result.error().text();
    EXPECT_GT(result->measures.flips, 0U);
    const auto lattice = map::quantise(*result);
    for (const auto& planes : lattice.planes) {
        EXPECT_GE(planes.size(), 2U);
    }
}

TEST(Map, RefusesLabelsThatDoNotFit) {
    const auto surface = tests::sphere(10, 24, 13);
    decomp::Run run;
    const auto tets = tets::tetrahedralise(surface, run);
    ASSERT_TRUE(tets.has_value());
    EXPECT_EQ(map::map_to_polycube(*tets, surface, {}, {}, run).error().code, "map.labels");
    const auto other = tests::torus(10, 4, 24, 13);
    EXPECT_EQ(map::map_to_polycube(*tets, other, tests::facing(other), {}, run).error().code,
              "map.labels");
}

}  // namespace
