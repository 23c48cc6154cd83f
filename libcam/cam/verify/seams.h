// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/levels.h"
#include "cam/verify/slicer.h"

#include <vector>

namespace cam::verify {

/// Where the outer walls of a level begin and end.
struct SeamCount {
    int loops = 0;     ///< closed outer walls
    int touching = 0;  ///< of them, those that run along a face that touches another part
    int on_face = 0;   ///< of these, those that begin on it
};

/// Follows the beads of a level that the program calls outer walls. O(beads * mating edges).
/// @param mating  sections of the faces that touch other parts
[[nodiscard]] SeamCount count_seams(const std::vector<Bead>& beads, const Levels& levels,
                                    const Level& level, const std::vector<Section>& mating);

}  // namespace cam::verify
