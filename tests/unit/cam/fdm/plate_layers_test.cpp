// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/plate_layers.h"

#include "cam/fdm/plan_part.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using cam::fdm::merge_layers;
using cam::fdm::plan_part;
using cam::path::Feature;

TEST(PlateLayers, PartsOfDifferentHeightShareTheirLayers) {
    const cam::profile::FdmSetup setup;
    const auto low = plan_part(tests::box({-5, -5, 0}, {5, 5, 2.05}), setup, {});
    const auto high = plan_part(tests::box({-5, -5, 0}, {5, 5, 4.05}), setup, {});
    ASSERT_TRUE(low && high);
    const auto plate = merge_layers({{&*low, {-20, 0}}, {&*high, {20, 0}}}, setup);
    ASSERT_EQ(plate.layers.size(), high->layers.size());
    EXPECT_EQ(plate.layers[3].beads.size(),
              low->layers[3].beads.size() + high->layers[3].beads.size());
    EXPECT_EQ(plate.layers.back().beads.size(), high->layers.back().beads.size());
    for (std::size_t i = 0; i + 1 < plate.layers.size(); ++i) {
        EXPECT_LT(plate.layers[i].z_mm, plate.layers[i + 1].z_mm);
    }
}

TEST(PlateLayers, TheSkirtComesFirstAndKeepsItsDistance) {
    cam::profile::FdmSetup setup;
    setup.machine.process.elephant_foot_mm = 0;
    const auto part = plan_part(tests::box({-5, -5, 0}, {5, 5, 2}), setup, {});
    ASSERT_TRUE(part);
    const auto plate = merge_layers({{&*part, {0, 0}}}, setup);
    const auto& process = setup.machine.process;
    for (int i = 0; i < process.skirt_loops; ++i) {
        const auto& bead = plate.layers[0].beads.at(static_cast<std::size_t>(i));
        EXPECT_EQ(bead.feature, Feature::Skirt);
        for (const auto& p : bead.points) {
            const Eigen::Vector2d beyond = (p.cwiseAbs() - Eigen::Vector2d(5, 5)).cwiseMax(0);
            EXPECT_GE(beyond.norm() - bead.width_mm / 2, process.skirt_distance_mm - 0.11);
        }
    }
    EXPECT_NE(plate.layers[0].beads.at(2).feature, Feature::Skirt);
}

}  // namespace
