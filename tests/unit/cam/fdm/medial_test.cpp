// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/medial.h"

#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::medial_lines;
using cam::fdm::MedialLine;
using cam::fdm::pieces_of_one_width;
using cam::polygon::from_mm;
using tests::disc;
using tests::hole;
using tests::rectangle;

double length(const MedialLine& line) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        sum += (line[i + 1].at_mm - line[i].at_mm).norm();
    }
    return sum;
}

TEST(Medial, AStripHasOneLineInItsMiddle) {
    const auto lines = medial_lines({rectangle({0, 0}, {20, 0.6})}, 0.1);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(length(lines[0]), 20 - 0.6, 1e-3);
    for (const auto& point : lines[0]) {
        EXPECT_NEAR(point.at_mm.y(), 0.3, 1e-5);
        EXPECT_NEAR(point.width_mm, 0.6, 1e-5);
    }
}

TEST(Medial, ARingHasAClosedLine) {
    const auto lines = medial_lines({disc(10, 120), hole(disc(9.5, 120))}, 0.1);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(length(lines[0]), 2 * std::numbers::pi * 9.75, 0.1);
    EXPECT_EQ(lines[0].front().at_mm, lines[0].back().at_mm);
}

TEST(Medial, AWedgeIsFollowedUntilItIsTooNarrow) {
    const auto lines = medial_lines({{from_mm({0, 0}), from_mm({20, -1}), from_mm({20, 1})}}, 0.2);
    ASSERT_EQ(lines.size(), 1U);
    double least_x = 20;
    for (const auto& point : lines[0]) {
        least_x = std::min(least_x, point.at_mm.x());
        EXPECT_NEAR(point.at_mm.y(), 0, 1e-5);
        EXPECT_NEAR(point.width_mm, 2 * point.at_mm.x() * std::sin(std::atan(0.05)), 1e-3);
    }
    EXPECT_NEAR(least_x, 2, 0.01);
}

TEST(Medial, AnElbowIsFollowedRoundItsCorner) {
    const auto lines = medial_lines({{from_mm({0, 0}), from_mm({10, 0}), from_mm({10, 10}),
                                      from_mm({9.5, 10}), from_mm({9.5, 0.5}), from_mm({0, 0.5})}},
                                    0.1);
    double sum = 0;
    for (const auto& line : lines) {
        sum += length(line);
    }
    EXPECT_NEAR(sum, 9.5 + 9.5, 0.5);
}

TEST(Medial, PiecesKeepToTheStepAndMeet) {
    const MedialLine taper{{{0, 0}, 0.2}, {{10, 0}, 0.8}};
    const auto pieces = pieces_of_one_width(taper, 0.1);
    ASSERT_GE(pieces.size(), 6U);
    double area = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        area += pieces[i].width_mm * (pieces[i].points.back() - pieces[i].points.front()).norm();
        if (i > 0) {
            EXPECT_LE(std::abs(pieces[i].width_mm - pieces[i - 1].width_mm), 0.2);
            EXPECT_EQ(pieces[i].points.front(), pieces[i - 1].points.back());
        }
    }
    EXPECT_NEAR(area, 5, 1e-9);
}

}  // namespace
