// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/feeds/feeds.h"

#include "cam/profile/read_mill.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using cam::feeds::chip_thinning;
using cam::feeds::effective_diameter_mm;
using cam::feeds::Feeds;
using cam::feeds::feeds_for;
using cam::feeds::power_w;
using cam::profile::MillMachine;
using cam::profile::MillMaterial;
using cam::tool::Shape;
using cam::tool::Tool;

Tool flat(double diameter_mm, int flutes = 2) {
    Tool tool;
    tool.diameter_mm = diameter_mm;
    tool.flutes = flutes;
    return tool;
}

/// Nothing of it clamps anything.
MillMachine strong() {
    MillMachine machine;
    machine.spindle.max_rpm = 200000;
    machine.axes.max_feed_mm_per_min = {1e5, 1e5, 1e5};
    return machine;
}

double mm_per_min(decomp::Speed speed) { return speed.mm_per_s() * 60; }

TEST(Feeds, SpeedAndFeedFollowTheSurfaceSpeedAndTheChip) {
    MillMaterial material;
    material.surface_speed_m_per_min = 300;
    material.chip_load = 0.01;
    material.min_chip_mm = 0.01;
    const Feeds feeds = feeds_for(flat(6, 3), material, strong());
    EXPECT_NEAR(feeds.values.slot.spindle_rpm, 300000 / (std::numbers::pi * 6), 1);
    EXPECT_NEAR(mm_per_min(feeds.values.slot.feed), feeds.values.slot.spindle_rpm * 3 * 0.06, 5);
    EXPECT_NEAR(mm_per_min(feeds.values.slot.plunge),
                mm_per_min(feeds.values.slot.feed) * material.plunge_factor, 1e-6);
    EXPECT_DOUBLE_EQ(feeds.values.slot.step_down_mm, 0.5 * 0.5 * 6);
    EXPECT_TRUE(feeds.notes.empty());
}

TEST(Feeds, ThinChipsMayBeFedFaster) {
    EXPECT_DOUBLE_EQ(chip_thinning(6, 3), 1);
    EXPECT_DOUBLE_EQ(chip_thinning(6, 6), 1);
    EXPECT_NEAR(chip_thinning(10, 1), 10 / (2 * 3.0), 1e-12);
    EXPECT_GT(chip_thinning(6, 0.3), chip_thinning(6, 0.6));
}

TEST(Feeds, ABallCutsAtTheCircleOfItsDepth) {
    Tool ball = flat(6);
    ball.shape = Shape::Ball;
    EXPECT_NEAR(effective_diameter_mm(ball, 0.3), 2 * std::sqrt(0.3 * 5.7), 1e-12);
    EXPECT_DOUBLE_EQ(effective_diameter_mm(ball, 5), 6);
    EXPECT_DOUBLE_EQ(effective_diameter_mm(flat(6), 0.1), 6);
}

TEST(Feeds, ASlowAxisSlowsTheSpindleUntilChipsAreCutAgain) {
    MillMaterial pine = cam::profile::read_mill_material("pine").value();
    MillMachine machine = strong();
    machine.axes.max_feed_mm_per_min = {600, 600, 100};
    const Feeds feeds = feeds_for(flat(6), pine, machine);
    const auto& slot = feeds.values.slot;
    EXPECT_LE(mm_per_min(slot.feed), 600 + 1e-9);
    EXPECT_LE(mm_per_min(slot.plunge), 100 + 1e-9);
    EXPECT_LE(mm_per_min(slot.ramp), 100 + 1e-9);
    EXPECT_GE(mm_per_min(slot.feed) / slot.spindle_rpm / 2, pine.min_chip_mm - 1e-6);
    EXPECT_FALSE(feeds.notes.empty());
}

TEST(Feeds, DepthIsTakenBackUntilTheSpindleCanDriveIt) {
    const MillMaterial aluminium = cam::profile::read_mill_material("aluminium-6061").value();
    MillMachine machine = strong();
    machine.spindle.max_rpm = 24000;
    const Feeds free = feeds_for(flat(6), aluminium, machine);
    machine.spindle.power_w = free.rough_power_w / 4;
    const Feeds bound = feeds_for(flat(6), aluminium, machine);
    EXPECT_LT(bound.values.rough.step_down_mm, free.values.rough.step_down_mm);
    for (const auto* cut : {&bound.values.rough, &bound.values.slot}) {
        EXPECT_LE(power_w(aluminium, cut->step_down_mm, cut->step_over_mm, cut->feed),
                  machine.spindle.power_w * (1 + 1e-9));
    }
    EXPECT_FALSE(bound.notes.empty());
}

TEST(Feeds, EveryShippedMillCanCutEveryShippedMaterialWithEveryToolWithinItsLimits) {
    for (const std::string& mill : cam::profile::list_mills()) {
        const auto machine = cam::profile::read_mill_setup(mill)->machine;
        for (const std::string& stock : cam::profile::list_mill_materials()) {
            const MillMaterial material = cam::profile::read_mill_material(stock).value();
            for (const std::string& name : cam::profile::list_tools()) {
                const Tool tool = cam::profile::read_tool(name).value();
                const auto values = feeds_for(tool, material, machine).values;
                for (const auto& cut : {values.rough, values.slot, values.finish, values.drill}) {
                    if (cut.spindle_rpm > 0) {
                        EXPECT_GE(cut.spindle_rpm, machine.spindle.min_rpm);
                        EXPECT_LE(cut.spindle_rpm, machine.spindle.max_rpm);
                        EXPECT_GT(cut.feed.mm_per_s(), 0) << mill << stock << name;
                        EXPECT_GT(cut.step_down_mm, 0);
                        EXPECT_LE(mm_per_min(cut.plunge),
                                  machine.axes.max_feed_mm_per_min.z() + 1e-9);
                    }
                }
            }
        }
    }
}

TEST(Feeds, ADrillOnlyDrillsAndAVDoesNotRough) {
    const MillMaterial pine = cam::profile::read_mill_material("pine").value();
    Tool drill = flat(3);
    drill.shape = Shape::Drill;
    drill.point = decomp::Angle::degrees(118);
    EXPECT_EQ(feeds_for(drill, pine, strong()).values.rough.feed.mm_per_s(), 0);
    EXPECT_GT(feeds_for(drill, pine, strong()).values.drill.plunge.mm_per_s(), 0);
    Tool v = flat(6);
    v.shape = Shape::V;
    v.point = decomp::Angle::degrees(60);
    EXPECT_EQ(feeds_for(v, pine, strong()).values.rough.feed.mm_per_s(), 0);
    EXPECT_GT(feeds_for(v, pine, strong()).values.finish.feed.mm_per_s(), 0);
}

}  // namespace
