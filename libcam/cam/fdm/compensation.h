// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

namespace cam::fdm {

/// What plastic does to sizes, taken off beforehand. All in mm.
struct Compensation {
    double outline_inset_mm = 0;  ///< of outer outlines; negative: they grow
    double hole_growth_mm = 0;    ///< of the radius of round holes
    double mating_inset_mm = 0;   ///< of stretches that touch another part
    double foot_inset_mm = 0;     ///< of everything, where it leaves room for two beads
    double least_width_mm = 0.9;  ///< narrower places keep their foot
};

/// A hole counts as round when its area is at least this share of that of a circle of its
/// perimeter: a hexagon does, a square does not.
inline constexpr double kRound = 0.88;
inline constexpr double kLargestHoleMm = 30;  ///< diameter of what counts as a hole for a pin

/// Whether a loop is a round hole.
[[nodiscard]] bool is_round_hole(const polygon::Path& loop);

/// A slice as it must be drawn to come out as it is meant. @param mating  lines, see mating_lines()
[[nodiscard]] polygon::Paths compensated(const polygon::Paths& slice, const polygon::Paths& mating,
                                         const Compensation& by);

}  // namespace cam::fdm
