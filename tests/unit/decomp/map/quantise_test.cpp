// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/quantise.h"

#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace decomp;

/// A pair whose polycube is the voxel shape itself, with coordinates moved along x by `shift`.
tets::Pair voxels(const std::array<int, 3>& size, const std::function<bool(int, int, int)>& filled,
                  const std::function<double(double)>& x_of) {
    const auto mesh = tests::voxel_tets(size, filled);
    tets::Pair pair{mesh.points, mesh.points, mesh.tets};
    for (Eigen::Vector3d& p : pair.polycube) {
        p.x() = x_of(p.x());
    }
    return pair;
}

bool stairs(int i, int, int k) { return k <= i; }

TEST(Quantise, PlanesOfAVoxelShapeAreItsCoordinates) {
    const auto pair = voxels({3, 1, 3}, stairs, [](double x) { return x; });
    const auto lattice = map::lattice_of(pair);
    EXPECT_EQ(lattice.planes[0], (std::vector<double>{0, 1, 2, 3}));
    EXPECT_EQ(lattice.planes[1], (std::vector<double>{0, 1}));
    EXPECT_EQ(lattice.planes[2], (std::vector<double>{0, 1, 2, 3}));
}

TEST(Quantise, NearPlanesAreMergedAndTheOutermostStay) {
    // Steps at 1 and 1.1 of 3: 3 % apart.
    const auto pair = voxels({3, 1, 3}, stairs, [](double x) { return x == 2 ? 1.1 : x; });
    const auto merged = map::lattice_of(pair, 0.08);
    ASSERT_EQ(merged.planes[0].size(), 3U);
    EXPECT_GT(merged.planes[0][1], 1.0);
    EXPECT_LT(merged.planes[0][1], 1.1);
    EXPECT_EQ(merged.planes[0].front(), 0);
    EXPECT_EQ(merged.planes[0].back(), 3);
    EXPECT_EQ(map::lattice_of(pair, 0.025).planes[0].size(), 4U);
}

TEST(Quantise, TheTwoFacesOfAThinWallAreNeverMerged) {
    // A wall of 3 % stands between two blocks of different height.
    const auto pair = voxels(
        {3, 1, 3}, [](int i, int, int k) { return k == 0 || i == 1; },
        [](double x) { return x == 2 ? 1.1 : x; });
    const auto lattice = map::lattice_of(pair, 0.08);
    EXPECT_EQ(lattice.planes[0].size(), 4U);
}

TEST(Quantise, AMirroredPairHasTheSameLabelsSeenFromOutside) {
    auto pair = voxels(
        {2, 1, 1}, [](int, int, int) { return true; }, [](double x) { return -x; });
    const auto labels = map::labels_of(pair);
    const auto lattice = map::lattice_of(pair);
    EXPECT_EQ(lattice.planes[0], (std::vector<double>{-2, 0}));
    EXPECT_EQ(std::count(labels.begin(), labels.end(), labels::AxisLabel::PlusX), 2);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), labels::AxisLabel::MinusX), 2);
}

}  // namespace
