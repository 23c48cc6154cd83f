// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"
#include "cam/verify/slicer.h"

#include <Eigen/Core>

#include <vector>

namespace cam::verify {

/// A round hole of a section, as drawn in the part.
struct RoundHole {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double diameter_mm = 0;  ///< of the circle of its area
    double reach_mm = 0;     ///< from the centre to its furthest point
};

/// The holes of a section that are nearly circles of 1 .. 30 mm. O(edges log edges).
[[nodiscard]] std::vector<RoundHole> round_holes(const Section& section);

/// Diameter of the circle that a hole's free pixels fill: those within its reach and the first wall
/// that no bead covers. O(pixels of the hole).
/// @param inside  the part's section, of the same window as `beads`
[[nodiscard]] double free_diameter_mm(const RoundHole& hole, const Bitmap& inside,
                                      const Bitmap& beads, double pixel_mm);

}  // namespace cam::verify
