// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/task.h"
#include "decomp/part/part.h"
#include "tests/support/cutters.h"

#include <utility>

/// What milling needs, made in code.
namespace tests {

inline cam::path::CutValues cut_values(double feed_mm_per_min, double down_mm, double over_mm) {
    cam::path::CutValues values;
    values.spindle_rpm = 12000;
    values.feed = decomp::Speed::mm_per_min(feed_mm_per_min);
    values.ramp = decomp::Speed::mm_per_min(feed_mm_per_min / 2);
    values.plunge = decomp::Speed::mm_per_min(feed_mm_per_min / 3);
    values.step_down_mm = down_mm;
    values.step_over_mm = over_mm;
    return values;
}

inline cam::mill::Cutter soft_cutter(cam::tool::Tool tool, int number) {
    tool.number = number;
    tool.flute_mm = 22;
    tool.stickout_mm = 35;
    tool.shank_diameter_mm = tool.diameter_mm;
    tool.holder = {{16, 19, 3}, {19, 19, 12}, {52, 52, 60}};
    cam::mill::Cutter cutter;
    const double d = tool.diameter_mm;
    cutter.tool = std::move(tool);
    cutter.feeds.rough = cut_values(1200, d, 0.4 * d);
    cutter.feeds.slot = cut_values(600, d, d);
    cutter.feeds.finish = cut_values(1500, d, 0.1 * d);
    return cutter;
}

inline cam::mill::MillTask soft_task(double ball_mm) {
    cam::mill::MillTask task;
    task.cutters = {soft_cutter(cutter(cam::tool::Shape::Flat, 6), 1),
                    soft_cutter(cutter(cam::tool::Shape::Ball, ball_mm), 2)};
    return task;
}

inline decomp::part::Part whole_part(decomp::mesh::TriMesh mesh) {
    decomp::part::Part part;
    part.id = "P01";
    part.sources.resize(mesh.triangles.size());
    part.mesh = std::move(mesh);
    return part;
}

/// A dome on a foot with upright sides, 40 mm across, 16 mm high, flat below.
inline decomp::mesh::TriMesh domed_plate() {
    return revolved(16, {{4, 15.5}, {9, 14}, {14, 10.5}, {16, 8}, {16, 6}, {20, 6}, {20, 0}}, 0,
                    72);
}

/// A round plate with a pocket whose wall leans outwards by a sixth of its height: the floor is
/// 16 mm across and 6 mm below the rim.
inline decomp::mesh::TriMesh dished_plate() {
    return revolved(4, {{8, 4}, {9, 10}, {14, 10}, {14, 0}}, 0, 72);
}

}  // namespace tests
