// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/trace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using cam::mill::Chain;
using cam::mill::Lattice;
using cam::mill::trace_level;

Lattice cone(int size) {
    Lattice lattice{size, size, {}};
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            lattice.values.push_back(
                static_cast<float>(std::hypot(column - size / 2, row - size / 2)));
        }
    }
    return lattice;
}

double area(const Chain& chain) {
    double twice = 0;
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
        const auto& a = chain.points[i];
        const auto& b = chain.points[(i + 1) % chain.points.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2;
}

TEST(Trace, AConeIsCutInACircleWithTheLowToTheLeft) {
    const auto chains = trace_level(cone(41), 12.5);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].closed);
    EXPECT_NEAR(area(chains[0]), std::acos(-1.0) * 12.5 * 12.5, 3);
    for (const auto& p : chains[0].points) {
        EXPECT_NEAR((p - Eigen::Vector2d(20, 20)).norm(), 12.5, 0.05);
    }
}

TEST(Trace, LinesThatLeaveTheLatticeAreOpen) {
    const auto chains = trace_level(cone(21), 12);
    ASSERT_EQ(chains.size(), 4U);
    for (const Chain& chain : chains) {
        EXPECT_FALSE(chain.closed);
    }
}

TEST(Trace, CellsThatNobodyWantsInterruptALine) {
    const auto chains =
        trace_level(cone(41), 12.5, [](int column, int /*row*/) { return column < 20; });
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_FALSE(chains[0].closed);
    for (const auto& p : chains[0].points) {
        EXPECT_LE(p.x(), 20);
    }
}

TEST(Trace, LowCornersAcrossASaddleStayApart) {
    const Lattice saddle{2, 2, {0, 1, 1, 0}};
    EXPECT_EQ(trace_level(saddle, 0.5).size(), 2U);
}

}  // namespace
