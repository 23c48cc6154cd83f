// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/walls.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::BeadSize;
using cam::fdm::make_walls;
using cam::polygon::area_mm2;
using tests::rectangle;

const BeadSize kBead{0.45, 0.2};

TEST(Walls, LieHalfAWidthInsideThenASpacingApart) {
    const auto walls = make_walls({rectangle({0, 0}, {20, 20})}, kBead, 3);
    ASSERT_EQ(walls.loops.size(), 3U);
    for (int i = 0; i < 3; ++i) {
        const double side = 20 - 2 * (0.225 + i * kBead.spacing_mm());
        EXPECT_NEAR(area_mm2(walls.loops.at(static_cast<std::size_t>(i))), side * side, 1e-4);
    }
    const double inner = 20 - 2 * (0.225 + 2.5 * kBead.spacing_mm());
    EXPECT_NEAR(area_mm2(walls.inside), inner * inner, 1e-4);
    EXPECT_TRUE(walls.thin.empty());
    EXPECT_TRUE(walls.gaps.empty());
}

TEST(Walls, AStripTooNarrowForTwoIsLeftAsThin) {
    const auto walls = make_walls({rectangle({0, 0}, {20, 0.6})}, kBead, 3);
    EXPECT_TRUE(walls.loops.empty());
    EXPECT_NEAR(area_mm2(walls.thin), 12, 1e-9);
    EXPECT_TRUE(walls.inside.empty());
}

TEST(Walls, AStripTooNarrowForASecondPairIsLeftAsGap) {
    const auto walls = make_walls({rectangle({0, 0}, {20, 1.2})}, kBead, 3);
    ASSERT_EQ(walls.loops.size(), 1U);
    const double edge = 0.225 + kBead.spacing_mm() / 2;
    EXPECT_NEAR(area_mm2(walls.gaps), (20 - 2 * edge) * (1.2 - 2 * edge), 1e-4);
}

}  // namespace
