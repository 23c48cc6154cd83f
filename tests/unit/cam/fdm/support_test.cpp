// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/support.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::find_supports;
using cam::fdm::SupportAreas;
using cam::fdm::SupportOptions;
using cam::polygon::area_mm2;
using cam::polygon::Paths;
using tests::rectangle;

constexpr std::size_t kLayers = 20;

/// A mast, and from layer 10 on what `arm` says.
std::vector<Paths> mast_with(const Paths& arm) {
    std::vector<Paths> slices(kLayers, Paths{rectangle({0, 0}, {10, 10})});
    for (std::size_t i = 10; i < kLayers; ++i) {
        slices[i] = arm;
    }
    return slices;
}

std::vector<SupportAreas> supports_of(const std::vector<Paths>& slices, double angle_degrees = 45) {
    SupportOptions options;
    options.angle = decomp::Angle::degrees(angle_degrees);
    return find_supports(slices, std::vector<Paths>(slices.size()), options, {});
}

double total_mm2(const SupportAreas& areas) {
    return area_mm2(areas.body) + area_mm2(areas.interface);
}

TEST(Support, AMastNeedsNone) {
    for (const auto& areas : supports_of(mast_with({rectangle({0, 0}, {10, 10})}))) {
        EXPECT_EQ(total_mm2(areas), 0);
    }
}

TEST(Support, AnArmStandsOnAColumnDownToTheBed) {
    const auto areas = supports_of(mast_with({rectangle({0, 0}, {30, 10})}));
    EXPECT_EQ(total_mm2(areas[9]), 0);  // the gap under the arm
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_GT(total_mm2(areas[i]), 19 * 10) << i;
    }
    EXPECT_GT(area_mm2(areas[8].interface), 19 * 10);
    EXPECT_GT(area_mm2(areas[6].interface), 19 * 10);
    EXPECT_NEAR(area_mm2(areas[5].interface), 0, 0.5);
}

TEST(Support, ColumnsKeepTheirGapBesideThePart) {
    const auto slices = mast_with({rectangle({0, 0}, {30, 10})});
    const auto areas = supports_of(slices);
    for (std::size_t i = 0; i < 9; ++i) {
        for (const Paths* region : {&areas[i].body, &areas[i].interface}) {
            for (const auto& loop : *region) {
                for (const auto& p : loop) {
                    EXPECT_GE(cam::polygon::to_mm(p).x(), 10.6 - 0.05);
                }
            }
        }
    }
}

TEST(Support, ALedgeOfHalfALineNeedsNone) {
    for (const auto& areas : supports_of(mast_with({rectangle({0, 0}, {10.22, 10})}))) {
        EXPECT_EQ(total_mm2(areas), 0);
    }
}

TEST(Support, AnIslandGetsAColumnEvenWithoutAnAngle) {
    const auto areas =
        supports_of(mast_with({rectangle({0, 0}, {10, 10}), rectangle({14, 4}, {14.5, 4.5})}), 0);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_GT(total_mm2(areas[i]), 5) << i;
    }
}

TEST(Support, AStripTooNarrowToPrintCarriesNothing) {
    auto slices = mast_with({rectangle({0, 0}, {10, 10}), rectangle({14, 0}, {14.3, 10})});
    slices[9].push_back(rectangle({14, 0}, {14.05, 10}));
    const auto areas = supports_of(slices);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_GT(total_mm2(areas[i]), 10) << i;
    }
}

TEST(Support, AnIslandOverThePartStandsOnThePart) {
    std::vector<Paths> slices(kLayers, Paths{rectangle({0, 0}, {10, 10})});
    for (std::size_t i = 8; i < kLayers; ++i) {
        slices[i] = {};
    }
    for (std::size_t i = 15; i < kLayers; ++i) {
        slices[i] = {rectangle({4, 4}, {6, 6})};
    }
    const auto areas = supports_of(slices);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(total_mm2(areas[i]), 0) << i;
    }
    for (std::size_t i = 8; i < 14; ++i) {
        EXPECT_GT(total_mm2(areas[i]), 4) << i;
    }
}

TEST(Support, NoPieceIsTooNarrowForABeadOrStandsOnNothing) {
    // Pegs of many sizes that hang beside and over a wedge whose slope cuts into their columns.
    std::vector<Paths> slices(kLayers, Paths{});
    for (std::size_t i = 0; i < kLayers; ++i) {
        const double slope = 0.4 * static_cast<double>(i);
        slices[i] = {rectangle({slope, 0}, {20, 20})};
        if (i >= kLayers / 2) {
            for (int k = 0; k < 5; ++k) {
                const double y = 4.0 * k;
                slices[i] = cam::polygon::unite(
                    slices[i], {rectangle({-3.0 - k, y}, {-2.5, y + 0.3 + 0.2 * k})});
            }
        }
    }
    const auto areas = supports_of(slices);
    const double half = SupportOptions{}.line_width_mm / 2;
    Paths below;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        for (const Paths& kind : {areas[i].body, areas[i].interface}) {
            for (const auto& island : cam::polygon::islands(kind)) {
                EXPECT_FALSE(cam::polygon::offset(island.loops(), -half).empty()) << i;
            }
        }
        const Paths now = cam::polygon::unite(areas[i].body, areas[i].interface);
        if (i > 0) {
            const Paths carrying = cam::polygon::unite(below, slices[i - 1]);
            for (const auto& island : cam::polygon::islands(now)) {
                EXPECT_GT(cam::polygon::area_mm2(cam::polygon::intersect(island.loops(), carrying)),
                          0)
                    << i;
            }
        }
        below = now;
    }
}

TEST(Support, WhatABridgeCarriesNeedsNone) {
    const Paths arm{rectangle({0, 0}, {30, 10})};
    std::vector<Paths> carried(kLayers);
    carried[10] = {rectangle({9, -1}, {31, 11})};
    for (const auto& areas :
         find_supports(mast_with(arm), carried, {decomp::Angle::degrees(45)}, {})) {
        EXPECT_EQ(total_mm2(areas), 0);
    }
}

TEST(BetweenLines, NarrowPlacesOfAnAreaAreFound) {
    using cam::polygon::area_mm2;
    // A square with an arm, of which lines 2.5 mm apart may miss the arm.
    const cam::polygon::Paths area = cam::polygon::region_of(
        {tests::rectangle({0, 0}, {10, 10}), tests::rectangle({9, 4}, {20, 6})});
    EXPECT_NEAR(area_mm2(cam::fdm::between_lines(area, 2.5)), 10 * 2, 0.5);
    EXPECT_TRUE(cam::fdm::between_lines(area, 1.5).empty());
    EXPECT_TRUE(cam::fdm::between_lines({}, 2.5).empty());
}

}  // namespace
