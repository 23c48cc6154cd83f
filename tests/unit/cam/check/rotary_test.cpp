// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/rotary.h"

#include "tests/support/part_shapes.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::check::setup_from_model;
using cam::check::smallest_cylinder;
using cam::check::tool_direction;

constexpr double kPi = std::numbers::pi;

// The A equation of docs/frames.md, drawn there: p_machine = Rx(-a_sign A) p_setup.
TEST(Rotary, TheTableAtATurnsThatDirectionUp) {
    for (const int sign : {1, -1}) {
        for (int degrees = 0; degrees < 360; degrees += 15) {
            const double a = degrees * kPi / 180;
            const Eigen::Vector3d in_machine =
                Eigen::AngleAxisd(-sign * a, Eigen::Vector3d::UnitX()) * tool_direction(a, sign);
            EXPECT_NEAR((in_machine - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
        }
    }
}

TEST(Rotary, AtNinetyDegreesTheCutterSeesTheSideOfMinusY) {
    EXPECT_NEAR((tool_direction(kPi / 2, 1) - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((tool_direction(kPi / 2, -1) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
}

TEST(Rotary, TheSetUpFrameHasTheAxisAlongXAndUpAboveIt) {
    auto mesh = tests::cylinder_x(7, 40, 60);
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.33).normalized().toRotationMatrix();
    map.translation() = Eigen::Vector3d(11, 12, 13);
    for (auto& point : mesh.points) {
        point = map * point;
    }
    const Eigen::Vector3d axis = map.linear().col(0);
    const auto cylinder = smallest_cylinder(mesh, axis);
    EXPECT_NEAR(cylinder.radius_mm, 7, 1e-9);
    EXPECT_NEAR(cylinder.length_mm, 40, 1e-9);
    const auto pose = setup_from_model(cylinder);
    EXPECT_NEAR(pose.map().linear().determinant(), 1, 1e-12);
    for (const auto& point : mesh.points) {
        const Eigen::Vector3d p = pose * point;
        EXPECT_GE(p.x(), -1e-9);
        EXPECT_LE(p.x(), 40 + 1e-9);
        EXPECT_LE(p.tail<2>().norm(), 7 + 1e-9);
    }
    EXPECT_NEAR(pose.turn(axis).x(), 1, 1e-12);
    EXPECT_GT(pose.turn(Eigen::Vector3d::UnitZ()).z(), 0);
}

TEST(Rotary, DirectionsOfTheModelAreThoseOfTheSetUp) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
    const auto pose = setup_from_model(smallest_cylinder(tests::box({0, 0, 0}, {1, 2, 3}), axis));
    const auto directions = cam::check::tool_directions(axis, 40, 1);
    for (int j = 0; j < 40; ++j) {
        const double a = cam::check::a_degrees(j, 40) * kPi / 180;
        EXPECT_NEAR(
            (pose.turn(directions[static_cast<std::size_t>(j)]) - tool_direction(a, 1)).norm(), 0,
            1e-12);
    }
}

TEST(Rotary, TheSmallestCylinderOfABoxHasItsDiagonal) {
    const auto box = tests::box({-3, 5, 1}, {7, 9, 4});
    EXPECT_NEAR(smallest_cylinder(box, Eigen::Vector3d::UnitX()).radius_mm, 2.5, 1e-9);
    EXPECT_NEAR(smallest_cylinder(box, Eigen::Vector3d::UnitZ()).radius_mm, std::sqrt(29), 1e-9);
}

}  // namespace
