// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"
#include "cam/verify/levels.h"

#include <cstdint>
#include <vector>

namespace cam::verify {

/// The pixels of `hanging` further than `distance_mm` from any pixel of `grounded`. O(words *
/// distance).
[[nodiscard]] Bitmap far_from(const Bitmap& hanging, const Bitmap& grounded, double distance_mm,
                              double pixel_mm);

/// For each bead of a level, whether it is part of a bridge: a straight run of beads, one after the
/// other, both ends of which lie on `anchors`. O(beads).
[[nodiscard]] std::vector<char> find_bridges(const std::vector<Bead>& beads, const Levels& levels,
                                             const Level& level, const Bitmap& anchors,
                                             double pixel_mm);

}  // namespace cam::verify
