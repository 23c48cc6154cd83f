// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/interface_neck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace {

using decomp::part::Assembly;
using decomp::sections::interface_neck_mm;

/// The first of two parts that touch at z = 5 along these triangles.
Assembly touching(std::vector<Eigen::Vector3d> points,
                  std::vector<decomp::mesh::Triangle> triangles) {
    Assembly out;
    out.planes = {{Eigen::Vector3d::UnitZ(), 5}};
    out.parts.resize(2);
    out.parts[0].sources.assign(triangles.size(), {0, 1});
    out.parts[0].mesh.points = std::move(points);
    out.parts[0].mesh.triangles = std::move(triangles);
    out.interfaces = {{0, 0, 1, 0}};
    return out;
}

double neck(const Assembly& assembly) {
    return interface_neck_mm(assembly, assembly.interfaces.front());
}

TEST(InterfaceNeck, OfARectangleIsItsShorterSide) {
    for (const double width : {40.0, 3.0, 0.2}) {
        const auto out = touching({{0, 0, 5}, {40, 0, 5}, {40, width, 5}, {0, width, 5}},
                                  {{0, 1, 2}, {0, 2, 3}});
        EXPECT_NEAR(neck(out), width, 0.011 * width);
    }
}

TEST(InterfaceNeck, OfATriangleIsItsInscribedCircle) {
    // Sides 3, 4, 5: radius 1.
    EXPECT_NEAR(neck(touching({{0, 0, 5}, {3, 0, 5}, {0, 4, 5}}, {{0, 1, 2}})), 2, 0.021);
}

TEST(InterfaceNeck, OfARingIsItsWidth) {
    constexpr std::uint32_t kAround = 64;
    std::vector<Eigen::Vector3d> points;
    std::vector<decomp::mesh::Triangle> triangles;
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const double angle = 2 * std::numbers::pi * i / kAround;
        points.emplace_back(20 * std::cos(angle), 20 * std::sin(angle), 5);
        points.emplace_back(26 * std::cos(angle), 26 * std::sin(angle), 5);
        const std::uint32_t next = (i + 1) % kAround;
        triangles.push_back({2 * i, 2 * i + 1, 2 * next + 1});
        triangles.push_back({2 * i, 2 * next + 1, 2 * next});
    }
    EXPECT_NEAR(neck(touching(points, triangles)), 6, 0.1);
}

TEST(InterfaceNeck, OfSeveralPiecesIsThatOfTheThinnest) {
    const auto out = touching({{0, 0, 5}, {9, 0, 5}, {9, 9, 5}, {50, 0, 5}, {53, 0, 5}, {50, 4, 5}},
                              {{0, 1, 2}, {3, 4, 5}});
    EXPECT_NEAR(neck(out), 2, 0.021);
}

TEST(InterfaceNeck, WithOtherNeighboursDoesNotCount) {
    auto out = touching({{0, 0, 5}, {3, 0, 5}, {0, 4, 5}, {50, 0, 5}, {50.1, 0, 5}, {50, 4, 5}},
                        {{0, 1, 2}, {3, 4, 5}});
    out.parts[0].sources[1].neighbour = 2;
    EXPECT_NEAR(neck(out), 2, 0.021);
}

}  // namespace
