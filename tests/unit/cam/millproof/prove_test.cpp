// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/prove.h"

#include "tests/support/mill_proofs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::millproof::MillJob;
using cam::millproof::MillProof;
using cam::millproof::prove;
using tests::ByHand;
using tests::fault_of;
using tests::words_of;

TEST(Prove, TheSameProgramPassesInEveryDialect) {
    const auto part = tests::pocket_part();
    for (const std::string& dialect : cam::profile::list_mill_dialects()) {
        const MillProof proof = prove(tests::text_of(tests::pocket_program(), dialect),
                                      tests::pocket_job(part, dialect), {})
                                    .value();
        EXPECT_TRUE(proof.passed()) << dialect << "\n" << words_of(proof);
        EXPECT_LE(proof.figures.max_excess_mm, 0.1 + 1e-9) << dialect;
    }
}

TEST(Prove, TheStockThatRemainsHasThePocketsVolume) {
    const auto part = tests::pocket_part();
    const MillProof proof =
        prove(tests::text_of(tests::pocket_program()), tests::pocket_job(part), {}).value();
    double taken = 0;
    for (const float z : proof.stock.height) {
        taken -= z * proof.stock.cell_mm * proof.stock.cell_mm;
    }
    const double corners = 4 * 9 * (1 - std::numbers::pi / 4);
    EXPECT_NEAR(taken, 4 * (24 * 14 - corners), 0.01 * 4 * 24 * 14);
}

TEST(Prove, CornersThatNoToolReachesAreForetoldAndFoundAlike) {
    const auto part = tests::pocket_part();
    const MillProof proof =
        prove(tests::text_of(tests::pocket_program()), tests::pocket_job(part), {}).value();
    EXPECT_GT(proof.figures.left, 0.005);
    EXPECT_NEAR(proof.figures.unreachable, proof.figures.left, 0.005);
}

TEST(Prove, AGougeOfABallOnASlopeIsMeasuredAlongTheNormal) {
    // A roof from Z -8 to Z 0 over 40 mm; the ball runs up it, too deep by 0.05 along the normal.
    decomp::mesh::TriMesh part;
    tests::add_quad(part, {0, 0, -8}, {40, 0, 0}, {40, 30, 0}, {0, 30, -8});
    const Eigen::Vector3d normal = Eigen::Vector3d(-8, 0, 40).normalized();
    for (const double deep : {0.0, 0.05}) {
        const auto tip = [&](double x) -> Eigen::Vector3d {
            const Eigen::Vector3d on(x, 15, -8 + x / 5);
            return on + normal * (3 - deep) - Eigen::Vector3d(0, 0, 3);
        };
        ByHand hand(tests::plate_stock());
        hand.take(2).rapid(tip(5).x(), 15, 5);
        hand.cut(tip(5).x(), 15, tip(5).z()).cut(tip(35).x(), 15, tip(35).z());
        hand.rapid(tip(35).x(), 15, 5);
        MillJob job = tests::pocket_job(part);
        job.tools.push_back({tests::ball_mill(2, 6), 800});
        job.finished = false;
        const MillProof proof = prove(tests::text_of(hand.done()), job, {}).value();
        EXPECT_NEAR(proof.figures.max_gouge_mm, deep, 2e-3) << words_of(proof);
        EXPECT_EQ(proof.passed(), deep == 0) << words_of(proof);
    }
}

/// A block from (10, 8) to (30, 22) whose top rises along X from Z -8 to Z 0: the edge at X 30 is
/// sharper than a right angle.
decomp::mesh::TriMesh wedge() {
    decomp::mesh::TriMesh mesh;
    tests::add_quad(mesh, {10, 8, -8}, {30, 8, 0}, {30, 22, 0}, {10, 22, -8});
    tests::add_quad(mesh, {30, 8, -10}, {30, 22, -10}, {30, 22, 0}, {30, 8, 0});
    tests::add_quad(mesh, {10, 22, -10}, {10, 8, -10}, {10, 8, -8}, {10, 22, -8});
    tests::add_quad(mesh, {10, 8, -10}, {30, 8, -10}, {30, 8, 0}, {10, 8, -8});
    tests::add_quad(mesh, {30, 22, -10}, {10, 22, -10}, {10, 22, -8}, {30, 22, 0});
    tests::add_quad(mesh, {10, 22, -10}, {30, 22, -10}, {30, 8, -10}, {10, 8, -10});
    return mesh;
}

/// A flat mill of 6 mm goes round the wedge, `off` from its walls.
MillProof wedge_gone_round(const decomp::mesh::TriMesh& part, double off) {
    const double by = 3 + off;
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(10 - by, 8 - by, 5).cut(10 - by, 8 - by, -10, 200);
    hand.cut(30 + by, 8 - by, -10).cut(30 + by, 22 + by, -10).cut(10 - by, 22 + by, -10);
    hand.cut(10 - by, 8 - by, -10).rapid(10 - by, 8 - by, 5);
    MillJob job = tests::pocket_job(part);
    job.finished = false;
    return prove(tests::text_of(hand.done()), job, {}).value();
}

TEST(Prove, WallsMayBeCutUpToEdgesSharperThanARightAngle) {
    const auto part = wedge();
    const MillProof proof = wedge_gone_round(part, 0);
    EXPECT_EQ(fault_of(proof, "gouge").kind, "") << words_of(proof);
    EXPECT_EQ(proof.figures.max_gouge_mm, 0);
}

TEST(Prove, AWallThatIsCutIsAGougeAsDeepAsTheCut) {
    const auto part = wedge();
    for (const double deep : {0.03, 0.1, 0.5}) {
        const MillProof proof = wedge_gone_round(part, -deep);
        EXPECT_GT(fault_of(proof, "gouge").line, 0) << deep;
        EXPECT_NEAR(proof.figures.max_gouge_mm, deep, 2e-3) << words_of(proof);
    }
}

TEST(Prove, APieceThatIsCutFreeIsLooseUnlessATabHoldsIt) {
    const auto part = tests::pocket_part();
    const auto contour = [&](bool tab) {
        ByHand hand(tests::plate_stock());
        hand.take(1).rapid(8, 8, 5).cut(8, 8, -10, 200);
        if (tab) {
            hand.cut(15, 8, -10).cut(15, 8, -7, 200).cut(25, 8, -7).cut(25, 8, -10, 200);
        }
        hand.cut(32, 8, -10).cut(32, 22, -10).cut(8, 22, -10).cut(8, 8, -10).rapid(8, 8, 5);
        MillJob job = tests::pocket_job(part);
        job.border_holds = true;
        return prove(tests::text_of(hand.done()), job, {}).value();
    };
    EXPECT_GT(fault_of(contour(false), "loose").line, 0);
    EXPECT_EQ(fault_of(contour(true), "loose").kind, "");
}

TEST(Prove, AHolderThatDipsIntoTheStockIsNamed) {
    const auto part = tests::pocket_part();
    MillJob job = tests::pocket_job(part);
    const std::string text = tests::text_of(tests::pocket_program());
    EXPECT_EQ(fault_of(prove(text, job, {}).value(), "holder").kind, "");
    job.tools[0].tool.flute_mm = 3;
    job.tools[0].tool.stickout_mm = 3;
    EXPECT_EQ(fault_of(prove(text, job, {}).value(), "holder").line,
              tests::line_with(text, "G1 Z-4.0000"));
}

TEST(Prove, ClampsFloorAndTravelAreKept) {
    const auto part = tests::pocket_part();
    MillJob job = tests::pocket_job(part);
    job.keep_outs = {{Eigen::Vector3d(20, 14, 0), Eigen::Vector3d(24, 18, 3)}};
    const std::string text = tests::text_of(tests::pocket_program());
    EXPECT_EQ(fault_of(prove(text, job, {}).value(), "clamp").kind, "clamp");
    job = tests::pocket_job(part);
    job.floor_z = -3;
    EXPECT_EQ(fault_of(prove(text, job, {}).value(), "floor").line,
              tests::line_with(text, "G1 Z-4.0000"));
    job = tests::pocket_job(part);
    job.machine.travel.max_mm.x() = job.machine.travel.min_mm.x() + 10;
    EXPECT_EQ(fault_of(prove(text, job, {}).value(), "limits").kind, "limits");
}

TEST(Prove, TimeCountsAcceleration) {
    const auto part = tests::pocket_part();
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(5, 15, 5).cut(35, 15, 5, 600);
    MillJob job = tests::pocket_job(part);
    job.finished = false;
    const double seconds = prove(tests::text_of(hand.done()), job, {}).value().figures.seconds;
    // 30 mm at 10 mm/s; speeding up and braking at 400 mm/s^2 takes 10/400 s more, less what the
    // junction's step of speed saves.
    EXPECT_GT(seconds, 3.0);
    EXPECT_LE(seconds, 3.0 + 10.0 / 400 + 1e-6);
}

TEST(Prove, WhatCannotBeProvedIsAnError) {
    const auto part = tests::pocket_part();
    MillJob job = tests::pocket_job(part);
    EXPECT_EQ(prove("M2\n", job, {.cell_mm = 0.001}).error().code, "millproof.job");
    job.tools.clear();
    EXPECT_EQ(prove("M2\n", job, {}).error().code, "millproof.job");
}

}  // namespace
