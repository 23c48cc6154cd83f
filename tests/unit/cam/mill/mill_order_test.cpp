// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/order.h"
#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using cam::mill::short_order;
using cam::mill::Stretch;
using Eigen::Vector2d;

double length_of(const std::vector<Stretch>& stretches, const std::vector<cam::mill::Turn>& order,
                 Vector2d at) {
    double length = 0;
    for (const auto& turn : order) {
        const Stretch& s = stretches[turn.index];
        length += (at - (turn.backwards ? s.last : s.first)).norm();
        at = turn.backwards ? s.first : s.last;
    }
    return length;
}

TEST(Order, ParallelLinesAreRunToAndFro) {
    std::vector<Stretch> lines;
    for (const int row : {3, 0, 2, 1, 4}) {
        lines.push_back({Vector2d(0, row), Vector2d(50, row)});
    }
    const auto order = short_order(lines, Vector2d(0, 0));
    ASSERT_EQ(order.size(), 5U);
    EXPECT_DOUBLE_EQ(length_of(lines, order, Vector2d(0, 0)), 4);
}

TEST(Order, EveryStretchComesOnceAndTheWayIsShorterThanAsGiven) {
    decomp::Rng rng(3);
    std::vector<Stretch> lines;
    std::vector<cam::mill::Turn> given;
    for (std::size_t i = 0; i < 200; ++i) {
        const Vector2d p(100 * rng.uniform(), 100 * rng.uniform());
        lines.push_back({p, p + Vector2d(5 * rng.uniform(), 0)});
        given.push_back({i, false});
    }
    const auto order = short_order(lines, Vector2d(0, 0));
    std::set<std::size_t> seen;
    for (const auto& turn : order) {
        seen.insert(turn.index);
    }
    EXPECT_EQ(seen.size(), lines.size());
    EXPECT_LT(length_of(lines, order, Vector2d(0, 0)),
              0.25 * length_of(lines, given, Vector2d(0, 0)));
}

}  // namespace
