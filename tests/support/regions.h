// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

/// Plane regions with known areas, made in code.
namespace tests {

/// Counter-clockwise rectangle, mm.
inline cam::polygon::Path rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    return {cam::polygon::from_mm(low), cam::polygon::from_mm({high.x(), low.y()}),
            cam::polygon::from_mm(high), cam::polygon::from_mm({low.x(), high.y()})};
}

/// Regular polygon round the origin, counter-clockwise.
inline cam::polygon::Path disc(double radius_mm, int corners) {
    cam::polygon::Path out;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * std::numbers::pi * i / corners;
        out.push_back(
            cam::polygon::from_mm({radius_mm * std::cos(turn), radius_mm * std::sin(turn)}));
    }
    return out;
}

/// The loop run the other way round: a hole.
inline cam::polygon::Path hole(cam::polygon::Path loop) {
    std::reverse(loop.begin(), loop.end());
    return loop;
}

}  // namespace tests
