// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/offset.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::polygon::area_mm2;
using cam::polygon::Join;
using cam::polygon::Paths;
using tests::hole;
using tests::rectangle;

TEST(Offset, AMiterKeepsTheCornersOfARectangle) {
    const Paths square{rectangle({0, 0}, {10, 10})};
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::offset(square, 1)), 144);
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::offset(square, -1)), 64);
}

TEST(Offset, ARoundJoinIsAMinkowskiSumWithADisc) {
    const Paths square{rectangle({0, 0}, {10, 10})};
    const double exact = 100 + 40 + std::numbers::pi;
    const double chords = 2 * std::numbers::pi * cam::polygon::kArcToleranceMm;
    EXPECT_NEAR(area_mm2(cam::polygon::offset(square, 1, Join::Round)), exact, chords);
}

TEST(Offset, HolesShrinkWhenTheRegionGrows) {
    const Paths ring{rectangle({0, 0}, {10, 10}), hole(rectangle({4, 4}, {6, 6}))};
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::offset(ring, 0.5)), 121 - 1);
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::offset(ring, 1)), 144);
}

TEST(Offset, OpeningRemovesWhatIsNarrowAndClosingFillsIt) {
    const Paths dumbbell = {{cam::polygon::from_mm({0, 0}), cam::polygon::from_mm({4, 0}),
                             cam::polygon::from_mm({4, 1.8}), cam::polygon::from_mm({8, 1.8}),
                             cam::polygon::from_mm({8, 0}), cam::polygon::from_mm({12, 0}),
                             cam::polygon::from_mm({12, 4}), cam::polygon::from_mm({8, 4}),
                             cam::polygon::from_mm({8, 2.2}), cam::polygon::from_mm({4, 2.2}),
                             cam::polygon::from_mm({4, 4}), cam::polygon::from_mm({0, 4})}};
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::opened(dumbbell, 0.5)), 32);
    const Paths two{rectangle({0, 0}, {4, 4}), rectangle({4.5, 0}, {8, 4})};
    EXPECT_DOUBLE_EQ(area_mm2(cam::polygon::closed(two, 0.5)), 32);
}

TEST(Offset, ThickenedLinesAreStadiums) {
    const Paths line{{cam::polygon::from_mm({0, 0}), cam::polygon::from_mm({10, 0})}};
    EXPECT_NEAR(area_mm2(cam::polygon::thickened(line, 1)), 20 + std::numbers::pi, 0.07);
}

}  // namespace
