// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/moves.h"

#include "tests/support/stacks.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using cam::motion::Move;
using cam::motion::MoveKind;

cam::profile::FdmSetup setup() { return cam::profile::read_fdm_setup("prusa-mk3s").value(); }

std::vector<Move> moves_of(const cam::path::LayerStack& stack, const cam::profile::FdmSetup& with) {
    std::vector<Move> out;
    cam::motion::trace(stack, with, [&](const Move& move) { out.push_back(move); });
    return out;
}

int count(const std::vector<Move>& moves, MoveKind kind) {
    int out = 0;
    for (const Move& move : moves) {
        out += move.kind == kind ? 1 : 0;
    }
    return out;
}

TEST(Moves, FilamentIsTheVolumeOfTheBeads) {
    cam::profile::FdmSetup with = setup();
    with.material.extrusion_multiplier = 1.1;
    double filament_mm = 0;
    for (const Move& move : moves_of({{{0.2, 0.2, {tests::square_bead(10, 10, 25)}}}}, with)) {
        filament_mm += move.kind == MoveKind::Extrude ? move.filament_mm : 0;
    }
    const double volume_mm3 = 100 * cam::path::bead_area_mm2(0.45, 0.2) * 1.1;
    EXPECT_NEAR(filament_mm * std::numbers::pi * 0.875 * 0.875, volume_mm3, 1e-9);
}

TEST(Moves, OnlyLongTravelsRetract) {
    cam::profile::FdmSetup with = setup();
    with.machine.retraction.min_travel_mm = 2;
    const auto retractions = [&](double gap_mm) {
        const auto moves = moves_of(
            {{{0.2, 0.2, {tests::square_bead(10, 10, 5), tests::square_bead(10 + gap_mm, 10, 5)}}}},
            with);
        EXPECT_EQ(count(moves, MoveKind::Retract), count(moves, MoveKind::Recover) + 1)
            << "ends retracted";
        return count(moves, MoveKind::Retract);
    };
    EXPECT_EQ(retractions(1.9), 2);  // before the first bead, and at the end
    EXPECT_EQ(retractions(2.1), 3);
}

TEST(Moves, ANewLayerIsReachedRetractedAndFromAbove) {
    cam::profile::FdmSetup with = setup();
    with.machine.retraction.lift_mm = 0.5;
    const auto moves = moves_of(tests::tower(2), with);
    bool retracted = false;
    double z_mm = 0;
    for (const Move& move : moves) {
        retracted = (retracted || move.kind == MoveKind::Retract) && move.kind != MoveKind::Recover;
        if (move.kind == MoveKind::Raise || move.kind == MoveKind::Lower) {
            EXPECT_TRUE(retracted);
            EXPECT_EQ(move.kind == MoveKind::Raise, move.to.z() > z_mm);
            z_mm = move.to.z();
        }
        if (move.kind == MoveKind::Extrude) {
            EXPECT_FALSE(retracted);
            EXPECT_EQ(move.to.z(), 0.2 * static_cast<double>(move.layer + 1));
        }
    }
}

TEST(Moves, TheLiftStopsAtTheTopOfTheChamber) {
    cam::profile::FdmSetup with = setup();
    with.machine.retraction.lift_mm = 0.5;
    with.machine.chamber.max_mm.z() = 0.7;
    for (const Move& move : moves_of(tests::tower(3), with)) {
        EXPECT_LE(move.to.z(), 0.7);
    }
}

TEST(Moves, NoBeadExceedsTheFlowOfNozzleAndMaterial) {
    cam::profile::FdmSetup with = setup();
    with.machine.nozzle.max_flow_mm3_per_s = 5;
    with.material.max_flow_mm3_per_s = 3;
    const cam::path::Bead bead = tests::square_bead(0, 0, 10, 200);
    const double speed = cam::motion::bead_speed_mm_per_s(bead, with);
    EXPECT_NEAR(speed * cam::path::bead_area_mm2(0.45, 0.2), 3, 1e-12);
    EXPECT_EQ(cam::motion::bead_speed_mm_per_s(tests::square_bead(0, 0, 10, 20), with), 20);
}

TEST(Moves, BeadsThatTouchNeedNoTravel) {
    cam::path::Bead second = tests::square_bead(10, 10, 5);
    const auto moves = moves_of({{{0.2, 0.2, {tests::square_bead(10, 10, 25), second}}}}, setup());
    EXPECT_EQ(count(moves, MoveKind::Travel), 1);
}

TEST(Moves, TravelsInsideThePartRetractOnlyWhenTheyAreLong) {
    cam::profile::FdmSetup with = setup();
    with.machine.retraction.min_travel_mm = 2;
    with.machine.retraction.max_inside_mm = 30;
    cam::path::Bead second = tests::square_bead(30, 10, 5);
    second.approach = {{{20, 12}}, true};
    const auto moves = [&] {
        return moves_of({{{0.2, 0.2, {tests::square_bead(10, 10, 5), second}}}}, with);
    };
    EXPECT_EQ(count(moves(), MoveKind::Retract), 2);
    EXPECT_EQ(count(moves(), MoveKind::Travel), 3) << "by way of the point between";
    with.machine.retraction.max_inside_mm = 15;
    EXPECT_EQ(count(moves(), MoveKind::Retract), 3);
    EXPECT_EQ(count(moves(), MoveKind::Travel), 3);
}

TEST(Moves, AWipeGoesBackAlongTheBeadAndPullsTheWholeRetraction) {
    cam::profile::FdmSetup with = setup();
    with.machine.retraction.wipe_mm = 7;
    double pulled_mm = 0;
    Eigen::Vector2d wiped_to = Eigen::Vector2d::Zero();
    for (const Move& move : moves_of({{{0.2, 0.2, {tests::square_bead(10, 10, 5)}}}}, with)) {
        if (move.kind == MoveKind::Wipe) {
            pulled_mm -= move.filament_mm;
            wiped_to = move.to.head<2>();
        }
    }
    EXPECT_NEAR(pulled_mm, with.machine.retraction.length_mm, 1e-12);
    // Back up the last side and two millimetres along the one before.
    EXPECT_NEAR((wiped_to - Eigen::Vector2d(12, 15)).norm(), 0, 1e-12);
}

TEST(Moves, APauseIsSpentRetractedAboveThePart) {
    cam::path::LayerStack stack = tests::tower(2);
    stack.layers[0].pause_s = 4;
    bool retracted = false;
    int pauses = 0;
    for (const Move& move : moves_of(stack, setup())) {
        retracted = (retracted || move.kind == MoveKind::Retract) && move.kind != MoveKind::Recover;
        if (move.kind == MoveKind::Pause) {
            ++pauses;
            EXPECT_EQ(move.seconds, 4);
            EXPECT_TRUE(retracted);
            EXPECT_GT(move.to.z(), 1);
        }
    }
    EXPECT_EQ(pauses, 1);
}

}  // namespace
