// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/profile.h"

#include "decomp/base/rng.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using decomp::part::Plane;
using decomp::sections::Event;
using decomp::sections::EventKind;
using decomp::sections::Profile;

Eigen::Affine3d random_turn(decomp::Rng& rng) {
    Eigen::Quaterniond q(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1),
                         rng.uniform(-1, 1));
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() = q.normalized().toRotationMatrix();
    map.translation() =
        Eigen::Vector3d(rng.uniform(-50, 50), rng.uniform(-50, 50), rng.uniform(-50, 50));
    return map;
}

std::vector<Event> of_kind(const std::vector<Event>& events, EventKind kind) {
    std::vector<Event> out;
    for (const Event& event : events) {
        if (event.kind == kind) {
            out.push_back(event);
        }
    }
    return out;
}

TEST(Profile, ABoxHasAConstantSection) {
    const auto box = tests::box({1, 2, 3}, {5, 7, 13});
    const Profile profile(box, Eigen::Vector3d::UnitZ(), 16);
    EXPECT_DOUBLE_EQ(profile.low_mm(), 3);
    EXPECT_DOUBLE_EQ(profile.high_mm(), 13);
    for (const auto& station : profile.stations()) {
        EXPECT_NEAR(station.area_mm2, 20, 1e-12);
        EXPECT_NEAR(station.slope_mm, 0, 1e-12);
        EXPECT_EQ(station.outlines, 1);
        EXPECT_EQ(station.holes, 0);
    }
    EXPECT_TRUE(profile.events().empty());
}

TEST(Profile, TheAreaIntegratesToTheVolumeInAnyDirection) {
    const auto torus = tests::torus(30, 9, 64, 32);
    decomp::Rng rng(3);
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d direction = random_turn(rng).linear() * Eigen::Vector3d::UnitX();
        const Profile profile(torus, direction, 400);
        double volume = 0;
        for (const auto& station : profile.stations()) {
            volume += station.area_mm2 * (profile.high_mm() - profile.low_mm()) / 400;
        }
        EXPECT_NEAR(volume / decomp::mesh::volume_mm3(torus), 1, 2e-3);
    }
}

TEST(Profile, TheSlopeIsTheDerivativeOfTheArea) {
    const auto ball = tests::sphere(10, 40, 21);
    const Profile profile(ball, Eigen::Vector3d(1, 2, 3).normalized(), 32);
    const double t = 3.21;
    const double h = 1e-5;
    const double difference = (profile.at(t + h).area_mm2 - profile.at(t - h).area_mm2) / (2 * h);
    EXPECT_NEAR(profile.at(t).slope_mm, difference, 1e-3 * std::abs(difference));
}

TEST(Profile, ATorusLyingDownIsARingAndStandingUpTwoDiscs) {
    const auto torus = tests::torus(30, 9, 64, 32);
    const auto lying = Profile(torus, Eigen::Vector3d::UnitZ(), 32).at(0.1);
    EXPECT_EQ(lying.outlines, 1);
    EXPECT_EQ(lying.holes, 1);
    EXPECT_EQ(lying.euler_number(), 0);
    const Profile standing(torus, Eigen::Vector3d::UnitX(), 64);
    EXPECT_EQ(standing.at(0.1).outlines, 2);
    EXPECT_EQ(standing.at(0.1).holes, 0);
    const auto changes = of_kind(standing.events(), EventKind::Topology);
    ASSERT_EQ(changes.size(), 2U);
    EXPECT_NEAR(changes[0].t_mm, -21, 0.2);
    EXPECT_NEAR(changes[1].t_mm, 21, 0.2);
}

TEST(Profile, AStepIsAJumpAtItsHeight) {
    const auto stepped = tests::revolved(60, {{10, 60}, {10, 20.001}, {40, 20}, {40, 0}}, 0, 48);
    const auto jumps =
        of_kind(Profile(stepped, Eigen::Vector3d::UnitZ()).events(), EventKind::Jump);
    ASSERT_EQ(jumps.size(), 1U);
    EXPECT_NEAR(jumps[0].t_mm, 20, 0.01);
}

TEST(Profile, TheNeckOfARandomlyTurnedDumbbellIsFoundWithinTwoPercent) {
    decomp::Rng rng(7);
    const double half = 100;
    for (int i = 0; i < 8; ++i) {
        const double neck_z = rng.uniform(-30, 30);
        const Eigen::Affine3d map = random_turn(rng);
        const auto shape = decomp::mesh::transformed(tests::dumbbell(35, 9, half, neck_z, 36), map);
        double best_area = 1e300;
        Plane best;
        for (const auto& direction : decomp::sections::directions(shape)) {
            const Profile profile(shape, direction);
            for (const Event& event : of_kind(profile.events(), EventKind::Neck)) {
                const Plane plane = decomp::sections::refined_neck(
                    shape, {direction, event.t_mm},
                    {.max_tilt = 0.6, .max_shift_mm = 15, .rounds = 12});
                const double area = decomp::sections::section_area(shape, plane);
                if (area < best_area) {
                    best_area = area;
                    best = plane;
                }
            }
        }
        ASSERT_LT(best_area, 1e300);
        const Eigen::Vector3d neck = map * Eigen::Vector3d(0, 0, neck_z);
        const Eigen::Vector3d axis = map.linear() * Eigen::Vector3d::UnitZ();
        EXPECT_LT(std::abs(best.normal.dot(neck) - best.offset_mm), 0.02 * 2 * half);
        EXPECT_GT(std::abs(best.normal.dot(axis)), std::cos(2 * std::numbers::pi / 180));
    }
}

TEST(Profile, AMeshWithoutTrianglesHasNoStations) {
    EXPECT_TRUE(Profile({}, Eigen::Vector3d::UnitZ()).stations().empty());
}

}  // namespace
