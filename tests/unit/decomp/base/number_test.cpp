// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/number.h"

#include <gtest/gtest.h>

namespace {

TEST(Number, NeverPrintsMinusZero) {
    EXPECT_EQ(decomp::decimal(-0.0004, 3), "0");
    EXPECT_EQ(decomp::fixed(-0.0004, 3), "0.000");
}

TEST(Number, KeepsTheSignOfNumbersBetweenMinusOneAndZero) {
    EXPECT_EQ(decomp::decimal(-0.5, 3), "-0.5");
}

TEST(Number, DropsTrailingZerosButNotThoseBeforeThePoint) {
    EXPECT_EQ(decomp::decimal(100, 3), "100");
    EXPECT_EQ(decomp::decimal(1.250, 3), "1.25");
    EXPECT_EQ(decomp::decimal(120, 0), "120");
}

TEST(Number, PadsTheFraction) { EXPECT_EQ(decomp::fixed(1.06, 4), "1.0600"); }

TEST(Number, ShortestReadsBackAsTheSameDouble) {
    for (const double value : {0.1, 1.0 / 3.0, 1e-300, -12345.678901234567}) {
        EXPECT_EQ(std::stod(decomp::shortest(value)), value);
    }
}

}  // namespace
