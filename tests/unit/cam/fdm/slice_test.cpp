// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/slice.h"

#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::slice;
using cam::polygon::area_mm2;
using cam::polygon::nanometres;

TEST(Slice, ABoxHasItsGroundPlanAtEveryHeight) {
    const auto regions = slice(tests::box({0, 0, 0}, {4, 3, 2}),
                               {nanometres(0.1), nanometres(1), nanometres(1.9)}, {});
    ASSERT_TRUE(regions);
    for (const auto& region : *regions) {
        EXPECT_EQ(region.size(), 1U);
        EXPECT_DOUBLE_EQ(area_mm2(region), 12);
    }
}

TEST(Slice, FacesInThePlaneBelongToTheLayerBelow) {
    const auto regions = slice(tests::box({0, 0, 0}, {4, 3, 2}),
                               {nanometres(-1), 0, nanometres(2), nanometres(3)}, {});
    ASSERT_TRUE(regions);
    EXPECT_TRUE((*regions)[0].empty());
    EXPECT_TRUE((*regions)[1].empty());
    EXPECT_DOUBLE_EQ(area_mm2((*regions)[2]), 12);
    EXPECT_TRUE((*regions)[3].empty());
}

TEST(Slice, ASphereHasRegularPolygonsAtTheHeightsOfItsRings) {
    constexpr std::uint32_t kAround = 60;
    const auto ball = tests::sphere(10, kAround, 29);
    for (const int ring : {3, 14, 20}) {
        const double polar = std::numbers::pi * ring / 30.0;
        const double r = 10 * std::sin(polar);
        const auto regions = slice(ball, {nanometres(10 * std::cos(polar))}, {});
        ASSERT_TRUE(regions);
        const double exact = 0.5 * kAround * r * r * std::sin(2 * std::numbers::pi / kAround);
        EXPECT_NEAR(area_mm2(regions->front()), exact, exact * 1e-4);
    }
}

TEST(Slice, ATorusCutThroughItsMiddleIsARing) {
    const auto regions = slice(tests::torus(10, 3, 64, 32), {nanometres(0.01)}, {});
    ASSERT_TRUE(regions);
    EXPECT_EQ(regions->front().size(), 2U);
}

TEST(Slice, ACavityIsAHole) {
    const auto shell = tests::joined(tests::box({0, 0, 0}, {10, 10, 10}),
                                     tests::flipped(tests::box({2, 2, 2}, {8, 8, 8})));
    const auto regions = slice(shell, {nanometres(1), nanometres(5)}, {});
    ASSERT_TRUE(regions);
    EXPECT_DOUBLE_EQ(area_mm2((*regions)[0]), 100);
    EXPECT_DOUBLE_EQ(area_mm2((*regions)[1]), 64);
}

TEST(Slice, AreasTimesHeightAddUpToTheVolume) {
    const auto ball = tests::sphere(10, 96, 63);
    std::vector<std::int64_t> heights;
    for (int i = 0; i < 400; ++i) {
        heights.push_back(nanometres(-10 + 0.05 * (i + 0.5)));
    }
    const auto regions = slice(ball, heights, {});
    ASSERT_TRUE(regions);
    double volume = 0;
    for (const auto& region : *regions) {
        volume += 0.05 * area_mm2(region);
    }
    EXPECT_NEAR(volume, 4.0 / 3 * std::numbers::pi * 1000, 10);
}

TEST(Slice, AMeshWithAHoleIsAnError) {
    auto open = tests::box({0, 0, 0}, {1, 1, 1});
    open.triangles.pop_back();
    const auto regions = slice(open, {nanometres(0.5)}, {});
    ASSERT_FALSE(regions);
    EXPECT_EQ(regions.error().code, "fdm.open_mesh");
}

}  // namespace
