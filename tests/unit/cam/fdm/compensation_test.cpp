// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/compensation.h"

#include "cam/fdm/mating.h"
#include "cam/polygon/boolean.h"
#include "tests/support/regions.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::compensated;
using cam::fdm::Compensation;
using cam::fdm::mating_lines;
using cam::polygon::area_mm2;
using cam::polygon::Paths;

/// A plate of 40 x 20 mm with a round hole of 8 mm and a square one of 6 mm.
Paths plate() {
    auto round = tests::disc(4, 90);
    auto square = tests::rectangle({8, -3}, {14, 3});
    return {tests::rectangle({-20, -10}, {20, 10}), tests::hole(round), tests::hole(square)};
}

Compensation nothing() { return {0, 0, 0, 0, 0.9}; }

TEST(Compensation, WithoutValuesTheSliceStaysAsItIs) {
    EXPECT_EQ(compensated(plate(), {}, nothing()), plate());
}

TEST(Compensation, RoundHolesGrowAndOthersDoNot) {
    Compensation by = nothing();
    by.hole_growth_mm = 0.2;
    const double lost = area_mm2(plate()) - area_mm2(compensated(plate(), {}, by));
    EXPECT_NEAR(lost, std::numbers::pi * (4.2 * 4.2 - 4 * 4), 0.05);
}

TEST(Compensation, AHexagonIsAHoleForAPinAndALongSlotIsNot) {
    EXPECT_TRUE(cam::fdm::is_round_hole(tests::hole(tests::disc(3, 6))));
    EXPECT_FALSE(cam::fdm::is_round_hole(tests::hole(tests::rectangle({0, 0}, {12, 3}))));
    EXPECT_FALSE(cam::fdm::is_round_hole(tests::hole(tests::disc(40, 90)))) << "no pin is that big";
    EXPECT_FALSE(cam::fdm::is_round_hole(tests::disc(3, 60))) << "an outline";
}

TEST(Compensation, TheOutlineIsDrawnInAndHolesStay) {
    Compensation by = nothing();
    by.outline_inset_mm = 0.1;
    const double lost = area_mm2(plate()) - area_mm2(compensated(plate(), {}, by));
    EXPECT_NEAR(lost, 40 * 20 - 39.8 * 19.8, 1e-3);
}

TEST(Compensation, AMatingFaceGivesItsGapAndTheOthersKeepTheirPlace) {
    Compensation by = nothing();
    by.mating_inset_mm = 0.05;
    const Paths face = {{cam::polygon::from_mm({20, -10}), cam::polygon::from_mm({20, 10})}};
    const Paths got = compensated(plate(), face, by);
    EXPECT_NEAR(area_mm2(plate()) - area_mm2(got), 20 * 0.05, 1e-3);
    const auto box = cam::polygon::bounds(got);
    EXPECT_EQ(box.max.x, cam::polygon::nanometres(19.95));
    EXPECT_EQ(box.min.x, cam::polygon::nanometres(-20));
    EXPECT_EQ(box.max.y, cam::polygon::nanometres(10));
}

TEST(Compensation, TheFootIsDrawnInAllRoundExceptWhereItIsThin) {
    Compensation by = nothing();
    by.foot_inset_mm = 0.2;
    by.least_width_mm = 1;
    // A square with a fin of 0.6 mm.
    const Paths shape = cam::polygon::unite({tests::rectangle({0, 0}, {10, 10})},
                                            {tests::rectangle({10, 5}, {20, 5.6})});
    const Paths got = foot_drawn_in(shape, shape, by);
    const auto box = cam::polygon::bounds(got);
    EXPECT_EQ(box.min.x, cam::polygon::nanometres(0.2));
    EXPECT_EQ(box.max.x, cam::polygon::nanometres(20)) << "the fin keeps its length";
    EXPECT_NEAR(area_mm2(got), 9.6 * 9.6 + 0.6 * 10.2, 0.3);
}

TEST(Compensation, AFootUnderAShelfIsNotDrawnIn) {
    Compensation by = nothing();
    by.foot_inset_mm = 0.1;
    by.least_width_mm = 1;
    const Paths slice = {tests::rectangle({0, 0}, {10, 10})};
    // The next layer sticks out by 0.2 mm at the right, by less than a foot at the top.
    const Paths above = {tests::rectangle({0, 0}, {10.2, 10.05})};
    const Paths got = foot_drawn_in(slice, above, by);
    const auto bounds_in = [&](const cam::polygon::Path& window) {
        return cam::polygon::bounds(cam::polygon::intersect(got, {window}));
    };
    const auto upright = bounds_in(tests::rectangle({3, -1}, {7, 11}));
    EXPECT_EQ(upright.min.y, cam::polygon::nanometres(0.1));
    EXPECT_EQ(upright.max.y, cam::polygon::nanometres(9.9));
    const auto across = bounds_in(tests::rectangle({-1, 3}, {11, 7}));
    EXPECT_EQ(across.min.x, cam::polygon::nanometres(0.1));
    EXPECT_EQ(across.max.x, cam::polygon::nanometres(10));
    // A countersink that opens towards the bed keeps the width that it is drawn with.
    const Paths square = {tests::rectangle({-5, -5}, {5, 5})};
    const Paths wide = cam::polygon::subtract(square, {tests::disc(3, 60)});
    const Paths narrow = cam::polygon::subtract(square, {tests::disc(2.8, 60)});
    const double at_the_outline = 10 * 10 - 9.8 * 9.8;
    EXPECT_NEAR(area_mm2(wide) - area_mm2(foot_drawn_in(wide, narrow, by)), at_the_outline, 0.2);
}

TEST(Mating, LinesRunWhereThePlaneMeetsTheMarkedFacets) {
    const auto box = tests::box({0, 0, 0}, {10, 20, 30});
    std::vector<bool> mating;
    for (const auto& t : box.triangles) {
        mating.push_back(
            std::all_of(t.begin(), t.end(), [&](auto v) { return box.points[v].x() == 10; }));
    }
    const auto lines = mating_lines(box, mating, {cam::polygon::nanometres(7)});
    ASSERT_EQ(lines.size(), 1U);
    ASSERT_EQ(lines[0].size(), 2U) << "two triangles";
    double length = 0;
    for (const auto& line : lines[0]) {
        const auto a = cam::polygon::to_mm(line[0]);
        const auto b = cam::polygon::to_mm(line[1]);
        EXPECT_EQ(a.x(), 10);
        EXPECT_EQ(b.x(), 10);
        length += (b - a).norm();
    }
    EXPECT_NEAR(length, 20, 1e-9);
    EXPECT_TRUE(mating_lines(box, {}, {cam::polygon::nanometres(7)})[0].empty());
}

}  // namespace
