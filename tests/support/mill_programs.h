// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_program.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <vector>

/// Milling programs made by hand: no planner has a part in them.
namespace tests {

inline cam::tool::Tool flat_mill(int number, double diameter_mm) {
    cam::tool::Tool tool;
    tool.name = "flat";
    tool.title = "flat end mill";
    tool.number = number;
    tool.diameter_mm = diameter_mm;
    tool.shank_diameter_mm = diameter_mm;
    tool.flute_mm = 20;
    tool.stickout_mm = 30;
    tool.holder = {{16, 19, 3}, {19, 19, 12}};
    return tool;
}

inline cam::tool::Tool ball_mill(int number, double diameter_mm) {
    cam::tool::Tool tool = flat_mill(number, diameter_mm);
    tool.name = "ball";
    tool.title = "ball end mill";
    tool.shape = cam::tool::Shape::Ball;
    return tool;
}

/// Writes moves one after the other.
class ByHand {
  public:
    explicit ByHand(Eigen::AlignedBox3d stock, double safe_z = 5) {
        program_.name = "top";
        program_.stock = stock;
        program_.safe_z = safe_z;
        program_.floor_z = stock.min().z();
    }

    ByHand& take(int number, double rpm = 12000) {
        spindle(0);
        add(cam::path::MillTakeTool{number});
        return spindle(rpm);
    }

    ByHand& spindle(double rpm) { return add(cam::path::MillSpindle{rpm}); }

    ByHand& rapid(double x, double y, double z) { return add(cam::path::MillRapid{{x, y, z}}); }

    ByHand& cut(double x, double y, double z, double mm_per_min = 600) {
        return add(cam::path::MillCut{{x, y, z}, decomp::Speed::mm_per_min(mm_per_min)});
    }

    ByHand& arc(Eigen::Vector3d to, Eigen::Vector2d centre, bool clockwise) {
        return add(cam::path::MillArc{to, centre, clockwise, decomp::Speed::mm_per_min(600)});
    }

    [[nodiscard]] cam::path::MillProgram done() {
        spindle(0);
        return program_;
    }

  private:
    ByHand& add(decltype(cam::path::MillMove::what) what) {
        program_.moves.push_back({cam::path::MillOperation::Rough, std::move(what)});
        return *this;
    }

    cam::path::MillProgram program_;
};

/// A plate 40 x 30 mm, top at 0, with a pocket 24 x 14 mm and 4 mm deep in its middle, corners of
/// 3 mm radius missing: cut with a flat mill of 6 mm in lanes of 2 mm.
inline Eigen::AlignedBox3d plate_stock() {
    return {Eigen::Vector3d(0, 0, -10), Eigen::Vector3d(40, 30, 0)};
}

inline cam::path::MillProgram pocket_program() {
    ByHand hand(plate_stock());
    hand.take(1).rapid(11, 11, 5).rapid(11, 11, 1);
    for (const double z : {-2.0, -4.0}) {
        hand.cut(11, 11, z, 200);
        hand.cut(29, 11, z).cut(29, 19, z).cut(11, 19, z).cut(11, 11, z);
        hand.cut(11, 15, z).cut(29, 15, z).cut(11, 11, z);
    }
    hand.rapid(11, 11, 5);
    return hand.done();
}

}  // namespace tests
