// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/tool/tool.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

/// Tools of every shape, and something to lower them on.
namespace tests {

inline cam::tool::Tool cutter(cam::tool::Shape shape, double diameter_mm) {
    cam::tool::Tool tool;
    tool.name = cam::tool::name_of(shape);
    tool.shape = shape;
    tool.diameter_mm = diameter_mm;
    return tool;
}

/// One of each: flat, ball, bull-nose, tapered ball, V with a tip, drill.
inline std::vector<cam::tool::Tool> one_of_each() {
    using cam::tool::Shape;
    std::vector<cam::tool::Tool> out{cutter(Shape::Flat, 6),     cutter(Shape::Ball, 6),
                                     cutter(Shape::BullNose, 6), cutter(Shape::TaperedBall, 5),
                                     cutter(Shape::V, 6),        cutter(Shape::Drill, 3)};
    out[2].corner_radius_mm = 1;
    out[3].tip_diameter_mm = 1;
    out[3].taper = decomp::Angle::degrees(5);
    out[4].tip_diameter_mm = 0.4;
    out[4].point = decomp::Angle::degrees(60);
    out[5].point = decomp::Angle::degrees(118);
    return out;
}

/// A ball with dents and a block that leans: smooth and sharp, valleys, ridges, walls.
inline decomp::mesh::TriMesh dented_ball_and_block() {
    decomp::mesh::TriMesh ball = sphere(12, 44, 30);
    for (Eigen::Vector3d& p : ball.points) {
        p *= 1 + 0.07 * std::sin(0.9 * p.x()) * std::cos(0.8 * p.y() + 1) * std::sin(0.7 * p.z());
    }
    decomp::mesh::TriMesh block = box({-5, -4, -9}, {6, 5, 9});
    const Eigen::Affine3d lean = Eigen::Translation3d(20, 1, 0) *
                                 Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.3, 1, 0.2).normalized());
    for (Eigen::Vector3d& p : block.points) {
        p = lean * p;
    }
    return joined(joined(ball, block), box({-24, -6, -9}, {-15, 8, 4}));
}

/// 204 160 triangles, 70 mm across: bumps of three sizes.
inline decomp::mesh::TriMesh bumpy_ball() {
    constexpr std::uint32_t n = 320;
    decomp::mesh::TriMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const double ph = std::numbers::pi * j / n;
            const double th = 2 * std::numbers::pi * i / n;
            const double r = 30 + 3 * std::sin(5 * ph) * std::cos(3 * th) +
                             1.5 * std::sin(11 * ph) * std::sin(9 * th) +
                             0.4 * std::sin(40 * ph) * std::cos(37 * th) * std::sin(ph);
            mesh.points.emplace_back(r * std::cos(ph), r * std::sin(ph) * std::cos(th),
                                     r * std::sin(ph) * std::sin(th));
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * n + i;
            const std::uint32_t b = j * n + (i + 1) % n;
            if (j > 0) {
                mesh.triangles.push_back({a, b + n, b});
            }
            if (j + 1 < n) {
                mesh.triangles.push_back({a, a + n, b + n});
            }
        }
    }
    return mesh;
}

}  // namespace tests
