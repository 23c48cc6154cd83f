// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"
#include "cam/verify/levels.h"

#include <cstdint>
#include <vector>

namespace cam::verify {

struct FarFrom {
    double distance_mm = 0;
    double enough_mm2 = 0;  ///< less than that is nothing
};

/// The pixels of `hanging` further than a distance from any pixel of `grounded`; none when they are
/// not enough. O(words * distance).
[[nodiscard]] Bitmap far_from(const Bitmap& hanging, const Bitmap& grounded, const FarFrom& rule,
                              double pixel_mm);

/// For each bead of a level, whether it is part of a bridge: a straight run of beads, one after the
/// other, both ends of which lie on `anchors`. O(beads).
[[nodiscard]] std::vector<char> find_bridges(const std::vector<Bead>& beads, const Levels& levels,
                                             const Level& level, const Bitmap& anchors,
                                             double pixel_mm);

}  // namespace cam::verify
