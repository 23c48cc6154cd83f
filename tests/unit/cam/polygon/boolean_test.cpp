// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/boolean.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::polygon::area_mm2;
using cam::polygon::Paths;
using tests::hole;
using tests::rectangle;

const Paths kLeft{rectangle({0, 0}, {4, 4})};
const Paths kRight{rectangle({2, 1}, {6, 3})};

TEST(Boolean, AreasOfUnionIntersectionAndDifferenceAddUp) {
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::unite(kLeft, kRight)), 16 + 8 - 4);
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::intersect(kLeft, kRight)), 4);
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::subtract(kLeft, kRight)), 12);
}

TEST(Boolean, EmptyRegionsAreNeutral) {
    EXPECT_EQ(cam::polygon::unite(kLeft, {}), kLeft);
    EXPECT_EQ(cam::polygon::subtract(kLeft, {}), kLeft);
    EXPECT_TRUE(cam::polygon::intersect(kLeft, {}).empty());
    EXPECT_TRUE(cam::polygon::subtract({}, kLeft).empty());
}

TEST(Boolean, TheRegionOfOverlappingLoopsIsTheirUnion) {
    const Paths raw{kLeft.front(), kRight.front()};
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::region_of(raw)), 20);
}

TEST(Boolean, TheRegionOfALoopTurnedInsideOutIsEmpty) {
    EXPECT_TRUE(cam::polygon::region_of({hole(kLeft.front())}).empty());
}

TEST(Boolean, LinesAreCutAtTheRegionsBoundary) {
    const Paths ring{rectangle({0, 0}, {10, 10}), hole(rectangle({4, 4}, {6, 6}))};
    const Paths line{{cam::polygon::from_mm({-5, 5}), cam::polygon::from_mm({15, 5})}};
    const auto length = [](const Paths& lines) {
        double sum = 0;
        for (const auto& piece : lines) {
            sum += (cam::polygon::to_mm(piece.back()) - cam::polygon::to_mm(piece.front())).norm();
        }
        return sum;
    };
    const Paths inside = cam::polygon::lines_inside(line, ring);
    EXPECT_EQ(inside.size(), 2U);
    EXPECT_DOUBLE_EQ(length(inside), 8);
    EXPECT_DOUBLE_EQ(length(cam::polygon::lines_outside(line, ring)), 12);
}

}  // namespace
