// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

namespace cam::polygon {

/// The points that loops wind around a positive number of times: makes a region out of raw slices.
[[nodiscard]] Paths region_of(const Paths& loops);

/// Booleans of regions. O((n + k) log n) for k crossings. A coordinate off the grid's range (4 *
/// 10^18) is a bug.
[[nodiscard]] Paths unite(const Paths& a, const Paths& b);
[[nodiscard]] Paths intersect(const Paths& a, const Paths& b);
[[nodiscard]] Paths subtract(const Paths& a, const Paths& b);

/// The pieces of open lines inside a region (or outside it). Pieces may run either way.
[[nodiscard]] Paths lines_inside(const Paths& lines, const Paths& region);
[[nodiscard]] Paths lines_outside(const Paths& lines, const Paths& region);

}  // namespace cam::polygon
