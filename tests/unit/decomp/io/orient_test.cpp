// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/orient.h"

#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::io::to_model_frame;
using decomp::io::Up;

TEST(ToModelFrame, EveryAxisIsTurnedToPlusZWithoutReflection) {
    const std::array<std::pair<Up, Eigen::Vector3d>, 6> axes{
        {{Up::X, Eigen::Vector3d::UnitX()},
         {Up::MinusX, -Eigen::Vector3d::UnitX()},
         {Up::Y, Eigen::Vector3d::UnitY()},
         {Up::MinusY, -Eigen::Vector3d::UnitY()},
         {Up::Z, Eigen::Vector3d::UnitZ()},
         {Up::MinusZ, -Eigen::Vector3d::UnitZ()}}};
    for (const auto& [up, axis] : axes) {
        auto mesh = tests::box({1, 2, 3}, {4, 7, 12});
        mesh.points[0] = axis;
        const auto turned = to_model_frame(mesh, up, std::nullopt);
        EXPECT_EQ(turned.points[0], Eigen::Vector3d::UnitZ());
        EXPECT_GT(
            decomp::mesh::volume_mm3(to_model_frame(tests::box({1, 2, 3}, {4, 7, 12}), up, {})), 0);
    }
}

TEST(ToModelFrame, TheHeightIsTheExtentAlongZ) {
    const auto mesh = to_model_frame(tests::box({0, 0, 0}, {2, 5, 3}), Up::Y, 245.0);
    EXPECT_NEAR(decomp::mesh::bounds(mesh).sizes().z(), 245, 1e-9);
    EXPECT_NEAR(decomp::mesh::bounds(mesh).sizes().x(), 98, 1e-9);
}

TEST(ChooseUp, AHalfSphereStandsOnItsFlatSide) {
    auto dome = tests::sphere(10, 24, 11);
    for (auto& point : dome.points) {
        point = {point.y(), std::max(point.z(), 0.0), point.x()};
    }
    EXPECT_EQ(decomp::io::choose_up(dome), Up::Y);
}

TEST(ChooseUp, AShapeWithoutABaseKeepsZ) {
    EXPECT_EQ(decomp::io::choose_up(tests::sphere(10, 24, 11)), Up::Z);
}

TEST(ParseUp, NamesComeBack) {
    for (const std::string_view name : {"x", "-x", "y", "-y", "z", "-z", "auto"}) {
        const auto up = decomp::io::parse_up(name);
        ASSERT_TRUE(up);
        EXPECT_EQ(decomp::io::name_of(*up), name);
    }
    EXPECT_EQ(decomp::io::parse_up("w").error().code, "io.up");
}

}  // namespace
