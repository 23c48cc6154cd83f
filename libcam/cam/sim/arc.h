// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/planner.h"

#include <vector>

namespace cam::sim {

/// An arc or helix in the plane of two axes.
struct Arc {
    Point from{};
    Point to{};
    std::size_t u = 0;  ///< first axis of the plane
    std::size_t v = 1;
    double centre_u = 0;
    double centre_v = 0;
    bool clockwise = false;  ///< seen against the third axis; equal ends: a whole turn
};

/// Corners of the chords that firmware makes of an arc; the last is exactly its end.
/// @param tolerance_mm  farthest that a chord is from the arc, as Grbl's $12
[[nodiscard]] std::vector<Point> arc_points(const Arc& arc, double tolerance_mm);

/// The centre of an arc that is given by its radius; negative: the longer way round. False: the
/// ends are the same or too far apart.
[[nodiscard]] bool centre_of(Arc& arc, double radius_mm);

}  // namespace cam::sim
