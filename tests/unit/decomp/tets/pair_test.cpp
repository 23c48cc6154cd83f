// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/pair.h"

#include "decomp/tets/measure.h"
#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace decomp;

tets::TetMesh block() {
    return tests::voxel_tets({2, 2, 1}, [](int, int, int) { return true; });
}

TEST(Pair, TetsInAnotherOrderWithTurnedCornersAreTheSame) {
    tets::TetMesh other = block();
    std::reverse(other.tets.begin(), other.tets.end());
    for (tets::Tet& tet : other.tets) {
        std::rotate(tet.begin(), tet.begin() + 1, tet.end());  // an odd permutation
    }
    const auto pair = tets::pair_of(other, block());
    ASSERT_TRUE(pair.has_value()) << pair.error().text();
    EXPECT_EQ(tets::measure(*pair).flips, 0U);
    EXPECT_NEAR(tets::measure(*pair).volume_mm3, 4.0, 1e-12);
}

TEST(Pair, ATetInvertedInThePolycubeCountsAsFlipped) {
    tets::TetMesh polycube = block();
    for (Eigen::Vector3d& p : polycube.points) {
        p.x() = -p.x();
    }
    const auto pair = tets::pair_of(block(), polycube);
    ASSERT_TRUE(pair.has_value());
    EXPECT_EQ(tets::measure(*pair).flips, pair->tets.size());
}

TEST(Pair, TheFirstTetThatDiffersIsNamed) {
    tets::TetMesh polycube = block();
    std::swap(polycube.tets[7][1], polycube.tets[7][0]);
    polycube.tets[7][0] = polycube.tets[7][0] == 0 ? 1 : 0;
    const auto pair = tets::pair_of(block(), polycube);
    ASSERT_FALSE(pair.has_value());
    EXPECT_EQ(pair.error().code, "tets.connectivity");
    EXPECT_NE(pair.error().message.find("tet 7 of the shape"), std::string::npos)
        << pair.error().message;
}

TEST(Pair, DifferentCountsAreNamed) {
    tets::TetMesh fewer = block();
    fewer.tets.pop_back();
    const auto pair = tets::pair_of(block(), fewer);
    ASSERT_FALSE(pair.has_value());
    EXPECT_NE(pair.error().message.find("24 tets, the polycube 23"), std::string::npos);
    tets::TetMesh more = block();
    more.points.emplace_back(0, 0, 9);
    EXPECT_EQ(tets::pair_of(block(), more).error().code, "tets.connectivity");
    EXPECT_EQ(tets::pair_of(block(), {}).error().code, "tets.empty");
}

}  // namespace
