// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/levels.h"

#include <cstddef>
#include <vector>

namespace cam::verify {

/// How a bead lies.
struct Lie {
    double height = 0;  ///< mm of material from what is under it up to the nozzle; 0: nothing there
    double area = 0;    ///< of its cross-section, mm^2
    double length = 0;  ///< mm
};

/// How the beads of one level lie.
struct Lies {
    std::vector<Lie> beads;     ///< in the order of the level
    double part_height_mm = 0;  ///< the usual one of beads of parts
    double own_height_mm = 0;   ///< of the thickest kind: supports may keep heights of their own
};

/// Measures the height of each bead from the rough deposits below it, not from the list of levels.
/// Those further than 1.2 mm down may be empty. O(samples along the beads).
[[nodiscard]] Lies find_lies(const std::vector<Bead>& beads, const Levels& levels,
                             std::size_t level, const std::vector<Bitmap>& below, double pixel_mm);

}  // namespace cam::verify
