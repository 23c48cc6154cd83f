// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

namespace cam::polygon {

/// What an offset makes of a convex corner: a sharp one (cut off beyond twice the offset) or an
/// arc.
enum class Join { Miter, Round };

/// Distance of an arc's chords from the arc, mm.
inline constexpr double kArcToleranceMm = 0.01;

/// The region grown by `delta_mm` (shrunk when negative).
[[nodiscard]] Paths offset(const Paths& region, double delta_mm, Join join = Join::Miter);

/// Shrunk, then grown back: what is narrower than twice the radius disappears.
[[nodiscard]] Paths opened(const Paths& region, double radius_mm, Join join = Join::Miter);

/// Grown, then shrunk back: gaps narrower than twice the radius close.
[[nodiscard]] Paths closed(const Paths& region, double radius_mm, Join join = Join::Miter);

/// The area within `radius_mm` of open lines, with round ends.
[[nodiscard]] Paths thickened(const Paths& lines, double radius_mm);

}  // namespace cam::polygon
