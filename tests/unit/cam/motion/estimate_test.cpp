// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/estimate.h"

#include "cam/motion/cooling.h"
#include "cam/motion/moves.h"
#include "tests/support/stacks.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace {

cam::profile::FdmSetup setup() { return cam::profile::read_fdm_setup("prusa-mk3s").value(); }

TEST(Estimate, LayersAddUpToTheWhole) {
    const auto estimate = cam::motion::estimate(tests::tower(5), setup());
    ASSERT_EQ(estimate.layer_seconds.size(), 5U);
    EXPECT_NEAR(std::accumulate(estimate.layer_seconds.begin(), estimate.layer_seconds.end(), 0.0),
                estimate.seconds, 1e-9);
    EXPECT_NEAR(estimate.layer_seconds[2], estimate.layer_seconds[3], 1e-6);
}

TEST(Estimate, IsAtLeastLengthOverSpeedAndNotMuchMore) {
    cam::path::LayerStack stack{{{0.2, 0.2, {tests::square_bead(0, 0, 100, 50)}}}};
    const double ideal = 400 / 50.0;
    const double seconds = cam::motion::estimate(stack, setup()).seconds;
    EXPECT_GT(seconds, ideal);
    EXPECT_LT(seconds, ideal + 0.5);
}

TEST(Estimate, MassAndCostFollowFromVolume) {
    cam::profile::FdmSetup with = setup();
    with.material.cost_per_kg = 20;
    const auto estimate =
        cam::motion::estimate({{{0.2, 0.2, {tests::square_bead(0, 0, 100)}}}}, with);
    const double volume_mm3 = 400 * cam::path::bead_area_mm2(0.45, 0.2);
    EXPECT_NEAR(estimate.filament_g, volume_mm3 / 1000 * with.material.density_g_per_cm3, 1e-9);
    EXPECT_NEAR(estimate.cost, estimate.filament_g * 0.02, 1e-12);
}

TEST(Cooling, AShortLayerTakesTheMinimumTime) {
    const cam::profile::FdmSetup with = setup();
    const auto slow = cam::motion::cooled(tests::tower(4, 15), with);
    const auto before = cam::motion::estimate(tests::tower(4, 15), with);
    ASSERT_LT(before.layer_seconds[1], with.material.min_layer_time_s - 1);
    for (const double seconds : cam::motion::estimate(slow, with).layer_seconds) {
        EXPECT_NEAR(seconds, with.material.min_layer_time_s, 0.5);
    }
}

TEST(Cooling, NeverGoesBelowTheFloorAndNeverFaster) {
    cam::profile::FdmSetup with = setup();
    with.material.min_layer_time_s = 100;
    const auto before = tests::tower(1, 15);
    const auto slow = cam::motion::cooled(before, with);
    for (std::size_t i = 0; i < slow.layers[0].beads.size(); ++i) {
        EXPECT_EQ(slow.layers[0].beads[i].speed, with.material.min_speed);
        EXPECT_LE(slow.layers[0].beads[i].speed, before.layers[0].beads[i].speed);
    }
}

TEST(Cooling, LeavesLongLayersAloneAndIsDoneOnce) {
    const cam::profile::FdmSetup with = setup();
    const auto big = tests::tower(1, 150);
    EXPECT_EQ(cam::motion::cooled(big, with).layers[0].beads[0].speed,
              big.layers[0].beads[0].speed);
    const auto once = cam::motion::cooled(tests::tower(3, 15), with);
    const auto twice = cam::motion::cooled(once, with);
    for (std::size_t i = 0; i < once.layers.size(); ++i) {
        for (std::size_t k = 0; k < once.layers[i].beads.size(); ++k) {
            EXPECT_EQ(once.layers[i].beads[k].speed, twice.layers[i].beads[k].speed);
        }
    }
}

TEST(Cooling, WaitsForWhatTheFloorDoesNotGive) {
    cam::profile::FdmSetup with = setup();
    with.material.min_layer_time_s = 100;
    const auto slow = cam::motion::cooled(tests::tower(2, 15), with);
    EXPECT_GT(slow.layers[0].pause_s, 1);
    for (const double seconds : cam::motion::estimate(slow, with).layer_seconds) {
        EXPECT_NEAR(seconds, 100, 1);
    }
    with.dialect.dwell.clear();
    EXPECT_EQ(cam::motion::cooled(tests::tower(2, 15), with).layers[0].pause_s, 0);
}

TEST(Estimate, ThePiecesOfALayerAddUpToIt) {
    const auto setup = cam::profile::read_fdm_setup("flashforge-creator-pro").value();
    const auto stack = tests::tower(4);
    const auto whole = cam::motion::estimate(stack, setup);
    cam::motion::PieceCounter counter;
    std::vector<double> sums(stack.layers.size(), 0.0);
    std::size_t next = 0;
    cam::motion::trace(stack, setup, [&](const cam::motion::Move& move) {
        const std::size_t piece = counter.piece_of(move);
        for (; next <= piece; ++next) {
            sums[move.layer] += whole.piece_seconds[next];
        }
    });
    EXPECT_EQ(next, whole.piece_seconds.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        EXPECT_NEAR(sums[i], whole.layer_seconds[i], 1e-9) << i;
    }
    EXPECT_GT(whole.piece_seconds.size(), stack.layers.size());
}

}  // namespace
