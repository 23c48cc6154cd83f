// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/trial_cut.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::part::Part;
using decomp::sections::trial_cut;
using decomp::sections::TrialPiece;

Part whole(const tests::TriMesh& mesh) {
    Part part;
    part.mesh = mesh;
    part.sources.resize(mesh.triangles.size());
    return part;
}

double total_volume(const std::vector<TrialPiece>& pieces) {
    double sum = 0;
    for (const TrialPiece& piece : pieces) {
        sum += piece.volume_mm3;
        EXPECT_NEAR(piece.volume_mm3, decomp::mesh::volume_mm3(piece.part.mesh),
                    1e-6 * piece.volume_mm3);
        EXPECT_TRUE(decomp::mesh::check_topology(piece.part.mesh).closed());
    }
    return sum;
}

TEST(TrialCut, ABoxGivesTwoPiecesThatAddUp) {
    const auto pieces = trial_cut(whole(tests::box({0, 0, 0}, {10, 20, 30})), {{0, 0, 1}, 12}, 4);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_NEAR(pieces[0].volume_mm3, 2400, 1e-9);
    EXPECT_NEAR(pieces[0].interface_mm2, 200, 1e-9);
    EXPECT_NEAR(pieces[0].bridge_mm, 12, 1e-9);
    EXPECT_FALSE(pieces[0].above);
    EXPECT_TRUE(pieces[1].above);
    EXPECT_NEAR(total_volume(pieces), 6000, 1e-9);
    EXPECT_EQ(pieces[0].part.sources.back().plane, 4);
}

TEST(TrialCut, AStandingTorusGivesTwoHorseshoesAndALowerCutTwoLegs) {
    const Part torus = whole(tests::torus(30, 9, 64, 32));
    EXPECT_EQ(trial_cut(torus, {{1, 0, 0}, 0.1}, 0).size(), 2U);
    const auto off_centre = trial_cut(torus, {{1, 0, 0}, 25}, 0);
    EXPECT_EQ(off_centre.size(), 2U);
    EXPECT_NEAR(total_volume(off_centre), decomp::mesh::volume_mm3(torus.mesh), 1e-6);
}

TEST(TrialCut, TheWallOfACavityStaysWithThePieceAroundIt) {
    const auto hollow =
        tests::joined(tests::sphere(20, 32, 17), tests::flipped(tests::sphere(10, 32, 17)));
    const double volume = decomp::mesh::volume_mm3(hollow);
    const auto opened = trial_cut(whole(hollow), {{0, 0, 1}, 1.03}, 0);
    ASSERT_EQ(opened.size(), 2U);
    EXPECT_NEAR(total_volume(opened), volume, 1e-6);
    const auto closed = trial_cut(whole(hollow), {{0, 0, 1}, 14.03}, 0);
    ASSERT_EQ(closed.size(), 2U);
    EXPECT_NEAR(total_volume(closed), volume, 1e-6);
}

TEST(TrialCut, APlaneThatMissesGivesTheWholePart) {
    const auto pieces = trial_cut(whole(tests::box({0, 0, 0}, {1, 1, 1})), {{0, 0, 1}, 7}, 0);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_DOUBLE_EQ(pieces[0].volume_mm3, 1);
}

TEST(TrialCut, APieceCanBeCutAgain) {
    const auto first = trial_cut(whole(tests::torus(30, 9, 64, 32)), {{0, 0, 1}, 0.3}, 0);
    ASSERT_EQ(first.size(), 2U);
    const auto second = trial_cut(first[0].part, {{1, 0, 0}, 0.2}, 1);
    EXPECT_EQ(second.size(), 2U);
    EXPECT_NEAR(total_volume(second), first[0].volume_mm3, 1e-6 * first[0].volume_mm3);
}

TEST(TrialCut, ACapThatEndsInAFeatherEdgeIsToldFromASquareCut) {
    const Part ball = whole(tests::sphere(20, 64, 41));
    EXPECT_LT(trial_cut(ball, {{0, 0, 1}, 0.1}, 0)[0].feather, 1e-6);
    EXPECT_GT(trial_cut(ball, {{0, 0, 1}, 19.5}, 0)[1].feather, 0.8);
}

}  // namespace
