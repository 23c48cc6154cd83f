// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/measure.h"

#include "tests/support/tet_shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using namespace decomp;

tets::Pair mapped(const Eigen::Matrix3d& map) {
    const auto shape = tests::voxel_tets({2, 1, 1}, [](int, int, int) { return true; });
    tets::Pair pair{shape.points, shape.points, shape.tets};
    for (Eigen::Vector3d& p : pair.polycube) {
        p = map * p;
    }
    return pair;
}

TEST(Measure, ARotationHasNoFlipsAndEnergyOne) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const auto measures = tets::measure(mapped(turn));
    EXPECT_EQ(measures.flips, 0U);
    EXPECT_NEAR(measures.symmetric_dirichlet, 1.0, 1e-12);
    EXPECT_NEAR(measures.volume_mm3, 2.0, 1e-12);
    EXPECT_NEAR(measures.polycube_mm3, 2.0, 1e-12);
}

TEST(Measure, AStretchHasTheEnergyOfItsSingularValues) {
    const auto measures = tets::measure(mapped(Eigen::Vector3d(2, 1, 0.5).asDiagonal()));
    EXPECT_NEAR(measures.symmetric_dirichlet, (4 + 1 + 0.25 + 0.25 + 1 + 4) / 6, 1e-12);
    EXPECT_NEAR(measures.least_determinant, 1.0, 1e-12);
}

TEST(Measure, AMirrorFlipsAllAndAFlatMapToo) {
    EXPECT_EQ(tets::measure(mapped(Eigen::Vector3d(-1, 1, 1).asDiagonal())).flips, 12U);
    const auto flat = tets::measure(mapped(Eigen::Vector3d(0, 1, 1).asDiagonal()));
    EXPECT_EQ(flat.flips, 12U);
    EXPECT_DOUBLE_EQ(flat.flipped_share, 1.0);
}

TEST(Measure, OneVertexPushedThroughItsNeighboursFlipsSomeOfTheVolume) {
    auto pair = mapped(Eigen::Matrix3d::Identity());
    pair.polycube[0] += Eigen::Vector3d(5, 0, 0);
    const auto measures = tets::measure(pair);
    EXPECT_GT(measures.flips, 0U);
    EXPECT_LT(measures.flipped_share, 1.0);
    EXPECT_LT(measures.least_determinant, 0.0);
}

}  // namespace
