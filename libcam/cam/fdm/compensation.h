// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

namespace cam::fdm {

/// What plastic does to sizes, taken off beforehand. All in mm.
struct Compensation {
    double outline_inset_mm = 0;  ///< of outer outlines; negative: they grow
    double hole_growth_mm = 0;    ///< of the radius of round holes
    double mating_inset_mm = 0;   ///< of stretches that touch another part
    double foot_inset_mm = 0;     ///< of the layer on the bed, see foot_drawn_in()
    double least_width_mm = 0.9;  ///< narrower places keep their foot
};

/// A hole counts as round when its area is at least this share of that of a circle of its
/// perimeter: a hexagon does, a square does not.
inline constexpr double kRound = 0.88;
inline constexpr double kLargestHoleMm = 30;  ///< diameter of what counts as a hole for a pin

/// Whether a loop is a round hole.
[[nodiscard]] bool is_round_hole(const polygon::Path& loop);

/// A slice as it must be drawn to come out as it is meant, its foot apart.
/// @param mating  lines, see mating_lines()
[[nodiscard]] polygon::Paths compensated(const polygon::Paths& slice, const polygon::Paths& mating,
                                         const Compensation& by);

/// The slice on the bed drawn in by what its foot spreads, except where that would leave less than
/// the least width, and where the slice above sticks out further than the foot does.
[[nodiscard]] polygon::Paths foot_drawn_in(const polygon::Paths& slice, const polygon::Paths& above,
                                           const Compensation& by);

}  // namespace cam::fdm
