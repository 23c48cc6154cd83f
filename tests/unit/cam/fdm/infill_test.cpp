// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/infill.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::fill_in_order;
using cam::fdm::fill_with_lines;
using cam::fdm::FillPattern;
using cam::fdm::Line;
using cam::polygon::Paths;
using decomp::Angle;
using tests::disc;
using tests::hole;
using tests::rectangle;

double length(const std::vector<Line>& lines) {
    double sum = 0;
    for (const Line& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            sum += (line[i + 1] - line[i]).norm();
        }
    }
    return sum;
}

TEST(Infill, ARectangleIsOneZigzag) {
    const auto lines = fill_with_lines({rectangle({0, 0.05}, {10, 5.05})}, {0.5, Angle(), 1});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(length(lines), 10 * 10 + 9 * 0.5, 1e-6);
}

TEST(Infill, WithoutLinksTheLinesStandAlone) {
    const auto lines = fill_with_lines({rectangle({0, 0.05}, {10, 5.05})}, {0.5, Angle(), -1});
    EXPECT_EQ(lines.size(), 10U);
    EXPECT_NEAR(length(lines), 100, 1e-6);
}

TEST(Infill, LinesStayOutOfHoles) {
    const Paths ring{disc(10, 180), hole(disc(5, 90))};
    for (const Line& line : fill_with_lines(ring, {0.4, Angle::degrees(30), 1.2})) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            for (const double t : {0.0, 0.25, 0.5, 0.75}) {
                const double r = (line[i] + t * (line[i + 1] - line[i])).norm();
                EXPECT_GE(r, 5 * std::cos(std::numbers::pi / 90) - 1e-6);
                EXPECT_LE(r, 10 + 1e-6);
            }
        }
    }
}

TEST(Infill, LengthTimesSpacingIsTheAreaAtAnyAngle) {
    const Paths region{disc(10, 180), hole(disc(3, 90))};
    const double spacing = 0.4;
    for (const double degrees : {0.0, 17.0, 45.0, 90.0, 135.0}) {
        const auto lines = fill_with_lines(region, {spacing, Angle::degrees(degrees), -1});
        EXPECT_NEAR(length(lines) * spacing / cam::polygon::area_mm2(region), 1, 0.005) << degrees;
    }
}

TEST(Infill, GridIsFixedToTheOriginSoThatLayersMeet) {
    for (const Line& line : fill_with_lines({disc(9, 60)}, {2, Angle(), -1})) {
        EXPECT_NEAR(std::remainder(line.front().y(), 2), 0, 1e-9);
    }
}

/// Middle of a level stretch, and its ends along it.
struct Level {
    double y, left, right;
};

std::vector<Level> levels_of(const std::vector<Line>& lines) {
    std::vector<Level> out;
    for (const Line& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const auto& a = line[i];
            const auto& b = line[i + 1];
            // Links along the holes' edges lie between the rows.
            const bool row = std::abs(std::remainder(a.y(), 0.5)) < 1e-6;
            if (row && std::abs(a.y() - b.y()) < 1e-9 && std::abs(a.x() - b.x()) > 0.05) {
                out.push_back({a.y(), std::min(a.x(), b.x()), std::max(a.x(), b.x())});
            }
        }
    }
    return out;
}

TEST(InfillInOrder, NoLineIsLaidBeforeTheOneBelowIt) {
    // Holes side by side and above one another: the sweep has to part and to meet again.
    const Paths region = {disc(10, 90), hole(rectangle({-6, -2.9}, {-2, 1.1})),
                          hole(rectangle({1, -1.1}, {4, 5.2})),
                          hole(rectangle({-5, 4.1}, {-3, 6.2}))};
    const FillPattern pattern{0.5, Angle(), 8};
    const auto lines = fill_in_order(region, pattern);
    const auto levels = levels_of(lines);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        for (std::size_t j = i + 1; j < levels.size(); ++j) {
            const bool beside = std::min(levels[i].right, levels[j].right) >
                                std::max(levels[i].left, levels[j].left);
            const bool below = std::abs(levels[i].y - 0.5 - levels[j].y) < 1e-6;
            EXPECT_FALSE(beside && below) << levels[j].y << " after " << levels[i].y;
        }
    }
    EXPECT_LE(lines.size(), 12U) << "few long zigzags";
    double swept = 0;
    double whole = 0;
    for (const Level& l : levels) {
        swept += l.right - l.left;
    }
    for (const Level& l : levels_of(fill_with_lines(region, pattern))) {
        whole += l.right - l.left;
    }
    EXPECT_NEAR(swept, whole, 1e-6);
}

TEST(InfillInOrder, ARectangleIsOneZigzag) {
    const auto lines = fill_in_order({rectangle({0, 0.05}, {10, 5.05})}, {0.5, Angle(), 1});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(length(lines), 10 * 10 + 9 * 0.5, 1e-6);
    EXPECT_TRUE(fill_in_order({}, {0.5, Angle(), 1}).empty());
}

}  // namespace
