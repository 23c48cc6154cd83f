// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/seams.h"

#include "cam/fdm/overhang_walls.h"
#include "tests/support/regions.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::Line;
using cam::fdm::SeamPlace;
using cam::fdm::SeamPlanner;
using cam::path::Bead;
using cam::path::Feature;
using cam::polygon::from_mm;
using Eigen::Vector2d;

/// A closed L whose inner corner is at (10, 10).
Line ell() { return {{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}, {0, 0}}; }

Line circle(double radius, double turn) {
    Line out;
    for (int i = 0; i <= 90; ++i) {
        const double a = 2 * std::numbers::pi * (i % 90) / 90 + turn;
        out.emplace_back(radius * std::cos(a), radius * std::sin(a));
    }
    return out;
}

Vector2d seam_of(SeamPlanner& planner, Line loop, const cam::polygon::Paths& mating = {}) {
    std::vector<Line> loops{std::move(loop)};
    planner.place_seams(loops, mating);
    EXPECT_EQ(loops[0].front(), loops[0].back());
    return loops[0].front();
}

TEST(Seams, HideInTheConcaveCorner) {
    SeamPlanner planner(SeamPlace::Hidden, 0.35);
    EXPECT_EQ(seam_of(planner, ell()), Vector2d(10, 10));
}

TEST(Seams, LieOnTheMatingFaceAwayFromItsEnds) {
    SeamPlanner planner(SeamPlace::Hidden, 0.35);
    // The wall's centre runs 0.225 mm inside the face, which has no vertex but its ends.
    const cam::polygon::Paths face = {{from_mm({-0.225, 20}), from_mm({-0.225, 0})}};
    const Vector2d seam = seam_of(planner, ell(), face);
    EXPECT_EQ(seam.x(), 0);
    EXPECT_GE(seam.y(), 1);
    EXPECT_LE(seam.y(), 19);
}

TEST(Seams, StandAboveEachOtherOnARoundPart) {
    for (const SeamPlace place : {SeamPlace::Hidden, SeamPlace::Aligned}) {
        SeamPlanner planner(place, 0.35);
        Vector2d below = seam_of(planner, circle(15, 0));
        for (int layer = 1; layer < 40; ++layer) {
            const Vector2d seam = seam_of(planner, circle(15 - 0.05 * layer, 0.37 * layer));
            EXPECT_LT((seam - below).norm(), 0.7) << layer;
            below = seam;
        }
    }
}

TEST(Seams, GoToTheRearWhenAsked) {
    SeamPlanner planner(SeamPlace::Rear, 0.35);
    EXPECT_EQ(seam_of(planner, ell()).y(), 20);
}

TEST(Seams, ALoopKeepsItsShape) {
    SeamPlanner planner(SeamPlace::Hidden, 0.35);
    std::vector<Line> loops{ell()};
    planner.place_seams(loops, {{from_mm({0, 20}), from_mm({0, 0})}});
    double length = 0;
    for (std::size_t i = 0; i + 1 < loops[0].size(); ++i) {
        length += (loops[0][i + 1] - loops[0][i]).norm();
    }
    EXPECT_NEAR(length, 80, 1e-9);
}

Bead wall(Line points) {
    Bead bead;
    bead.points = std::move(points);
    bead.width_mm = 0.45;
    bead.height_mm = 0.2;
    bead.speed = decomp::Speed::mm_per_s(45);
    return bead;
}

TEST(OverhangWalls, TheStretchOverAirIsSlowedAndNothingIsLost) {
    const cam::polygon::Paths below = {tests::rectangle({-1, -1}, {12, 21})};
    const auto pieces = cam::fdm::with_overhangs({wall(ell())}, below, decomp::Speed::mm_per_s(10));
    double over_air = 0;
    double length = 0;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        for (std::size_t i = 0; i + 1 < pieces[k].points.size(); ++i) {
            const double step = (pieces[k].points[i + 1] - pieces[k].points[i]).norm();
            length += step;
            over_air += pieces[k].feature == Feature::OverhangWall ? step : 0;
        }
        EXPECT_NEAR(pieces[k].speed.mm_per_s(),
                    pieces[k].feature == Feature::OverhangWall ? 10 : 45, 1e-9);
        if (k > 0) {
            EXPECT_EQ(pieces[k].points.front(), pieces[k - 1].points.back()) << "no travel between";
        }
    }
    EXPECT_NEAR(length, 80, 1e-9);
    EXPECT_NEAR(over_air, 8 + 10 + 8, 1e-9);
}

TEST(OverhangWalls, TheSpeedFallsWithTheShareOverAir) {
    // A wall 0.45 mm wide along an edge: its middle lies `inside` of it.
    const cam::polygon::Paths below = {tests::rectangle({0, 0}, {40, 10})};
    double last = 46;
    for (const double inside : {0.2, 0.08, -0.08, -0.2}) {
        const auto pieces = cam::fdm::with_overhangs({wall({{5, inside}, {35, inside}})}, below,
                                                     decomp::Speed::mm_per_s(15));
        ASSERT_EQ(pieces.size(), 1U) << inside;
        EXPECT_LT(pieces[0].speed.mm_per_s(), last) << inside;
        EXPECT_EQ(pieces[0].feature == Feature::OverhangWall, inside < 0) << inside;
        last = pieces[0].speed.mm_per_s();
    }
    EXPECT_NEAR(last, 15, 1e-9);
}

TEST(OverhangWalls, ShortStretchesAndInfillStayAsTheyAre) {
    const cam::polygon::Paths below = {tests::rectangle({-1, -1}, {19.8, 21})};
    Bead infill = wall({{0, 0}, {40, 0}});
    infill.feature = Feature::SparseInfill;
    Bead nearly = wall({{0, 5}, {20.5, 5}, {0, 6}});
    const auto pieces =
        cam::fdm::with_overhangs({infill, nearly}, below, decomp::Speed::mm_per_s(10));
    ASSERT_EQ(pieces.size(), 4U);
    EXPECT_EQ(pieces[0].points, infill.points);
    EXPECT_EQ(pieces[2].feature, Feature::OverhangWall) << "1.4 mm";
    const auto same = cam::fdm::with_overhangs({wall({{0, 5}, {20.2, 5}, {0, 5.1}})}, below,
                                               decomp::Speed::mm_per_s(10));
    EXPECT_EQ(same.size(), 1U) << "0.8 mm";
}

}  // namespace
