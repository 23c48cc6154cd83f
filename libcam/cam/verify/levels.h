// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"
#include "cam/verify/replay.h"

#include <cstdint>
#include <vector>

namespace cam::verify {

/// All beads at one height of the nozzle.
struct Level {
    double z = 0;
    std::uint32_t first = 0;  ///< range in Levels::order
    std::uint32_t last = 0;
    int layer = -1;         ///< counted over levels with material of parts; -1 for supports alone
    double step_part = 0;   ///< down to the next level that has material of parts, or to the bed
    double step_other = 0;  ///< the same among declared supports and adhesion
    long first_line = 0;
};

/// Beads sorted by height, in the order of the program within one height.
struct Levels {
    std::vector<std::uint32_t> order;
    std::vector<Level> levels;

    /// Layer whose top is nearest above z; -1 when there is none.
    [[nodiscard]] int layer_at(double z) const;
};

/// Heights within 0.01 mm are one level. O(n log n).
[[nodiscard]] Levels sort_levels(const std::vector<Bead>& beads);

/// Width of the stadium with this cross-section and height; a free strand when it would be taller
/// than wide.
[[nodiscard]] double bead_width(double area_mm2, double height_mm);

/// Diameter of a strand with this cross-section.
[[nodiscard]] double strand_diameter(double area_mm2);

[[nodiscard]] double bead_length(const Bead& bead);

/// The beads of a level with widths guessed from the step to the level below: what later levels
/// find beneath them.
[[nodiscard]] Bitmap rough_deposit(const std::vector<Bead>& beads, const Levels& levels,
                                   std::size_t level, double pixel_mm);

/// Pixels that hold every bead of a level, with a margin.
[[nodiscard]] Window window_of(const std::vector<Bead>& beads, const Levels& levels,
                               std::size_t level, double pixel_mm);

}  // namespace cam::verify
